#include "runtime/sim/contact/contact_step.h"

#include "mesher/base/stopwatch.h"

namespace liana {

ContactStepReport ContactStepper::step(Plant& plant, const CollisionScene& scene,
                                       std::span<const Wrench> external, std::vector<WorldSpring>& springs,
                                       const StepOptions& options, StepWorkspace& workspace) {
  ContactStepReport report;
  report.collision_seconds += timed([&] { report.contacts = contacts_.gather(plant, scene, springs); });
  size_t known = 0;
  for (;;) {
    report.step = known > 0 ? stepper_.again(plant, external, springs, known, options, workspace)
                            : stepper_.step(plant, external, springs, options, workspace);
    known = springs.size();
    report.solves += report.step.solves;
    if (++report.passes >= options_.most_passes) break;
    size_t missed = 0;
    report.collision_seconds += timed([&] {
      missed = contacts_.gather_missed(plant, stepper_.start(), scene, options_.tolerance, springs);
    });
    if (missed == 0) break;
    report.contacts.contacts += missed;
    stepper_.take_back(plant);
  }
  return report;
}

}  // namespace liana
