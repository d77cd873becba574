#include "runtime/sim/step/time_step.h"

#include <algorithm>

#include "mesher/base/parallel.h"
#include "runtime/sim/step/free_flight.h"
#include "runtime/sim/step/joint_projection.h"

namespace liana {
namespace {

// How far the plant's first particle is from where the world holds it.
Vec3 off_support(const Plant& plant) {
  if (plant.particles.empty() || plant.particles[0].joint.shear_stiffness.isZero(0)) return Vec3::Zero();
  const Motion& m = plant.motion[0];
  const Joint& joint = plant.particles[0].joint;
  return m.position + m.orientation * joint.on_self - joint.on_parent;
}

// What a step is redone with: generalized-α at ρ∞ = 0, at last backward Euler.
GeneralizedAlpha method_of(const TimeScheme& scheme, int finer, int finest) {
  if (finer == 1) return GeneralizedAlpha(scheme.rho_infinity);
  return 4 * finer > finest ? GeneralizedAlpha::backward_euler() : GeneralizedAlpha(0);
}

}  // namespace

StepReport PlantStepper::step_from(Plant& plant, std::span<const Wrench> external,
                                   std::span<const WorldSpring> transient, size_t known,
                                   const StepOptions& options, StepWorkspace& workspace) noexcept {
  if (plant.scheme.solver == Solver::ShapeMatching) {
    next_ = plant.motion;
    return shape_matching_.step(plant, external, transient, options);
  }
  start_threads(std::max(1u, options.threads));
  const Loads loads{external, transient};
  const size_t count = plant.particles.size();
  const bool some = known > 0 && workspace.holds(kept_) && solver_.particles() == count;
  kept_ = 0;
  workspace.forget();
  now_.resize(count);
  next_.resize(count);
  solver_.prepare(plant, transient, false);
  solver_.mark_stale(transient, some ? known : transient.size());
  start_gap_ = gap_;
  const double gap_limit =
      std::max(options.gap_limit, std::min(start_gap_ + options.slow.a_step, options.slow.most));
  StepReport report;
  report.calibrated = options.dt == plant.scheme.dt;
  for (int finer = 1;; finer *= 2) {
    take_substeps(plant, loads, finer, gap_limit, some && finer == 1, options, workspace, report);
    report.gap_held = report.gap <= gap_limit;
    if ((report.finite && report.gap_held) || 2 * finer > options.most_redo_substeps) break;
    ++report.redone;
  }
  if (report.solves == 1 && report.finite) kept_ = workspace.hold();
  accept(plant, loads, options, report);
  return report;
}

// The whole step in `finer` times as many substeps, into next_; ends early when another try is to come.
void PlantStepper::take_substeps(const Plant& plant, const Loads& loads, int finer, double gap_limit,
                                 bool only_stale, const StepOptions& options, StepWorkspace& workspace,
                                 StepReport& report) {
  const bool last = 2 * finer > options.most_redo_substeps;
  const int parts = plant.scheme.substeps * finer;
  // A support that jumped is carried to its new place within the step, when the step has to be redone.
  const Vec3 teleported = off_support(plant);
  Substep part{options.dt / parts, method_of(plant.scheme, finer, options.most_redo_substeps), loads.external,
               options.gravity, options.threads};
  report.gap = 0;
  report.finite = true;
  for (int i = 0; i < parts && report.finite && (last || report.gap <= gap_limit); ++i) {
    if (i > 0) now_.swap(next_);
    const std::span<const Motion> from = i == 0 ? plant.motion : now_;
    if (finer > 1) part.world = (1 - (i + 1.0) / parts) * teleported;
    part.only_stale = only_stale && i == 0;
    SubstepOutcome outcome = solver_.take(plant, part, from, next_, workspace);
    if (outcome.tree_changed) {
      solver_.prepare(plant, loads.transient, true);
      part.only_stale = false;
      outcome = solver_.take(plant, part, from, next_, workspace);
    }
    report.gap = std::max(report.gap, outcome.gap);
    report.finite = outcome.finite;
    ++report.solves;
  }
}

// The plant takes on next_, or stands still where it was; next_ becomes where it started.
void PlantStepper::accept(Plant& plant, const Loads& loads, const StepOptions& options, StepReport& report) {
  if (!report.finite) {
    next_ = plant.motion;
    for (Motion& m : plant.motion) m = {.position = m.position, .orientation = m.orientation};
    return;
  }
  plant.motion.swap(next_);
  if (!report.gap_held && options.most_redo_substeps > 1)
    report.projected = project_joints(plant, next_, options.gap_limit);
  gap_ = report.projected > 0 ? options.gap_limit : report.gap;
  if (plant.anchors.empty() && loads.transient.empty() && loads.external.empty())
    keep_angular_momentum(next_, plant);
}

}  // namespace liana
