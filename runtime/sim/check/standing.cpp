#include "runtime/sim/check/standing.h"

#include "runtime/sim/step/time_step.h"

namespace liana {
namespace {

// m, from the root to the farthest particle
double extent(std::span<const Motion> motion) {
  double distance = 0;
  for (const Motion& m : motion) distance = std::max(distance, (m.position - motion[0].position).norm());
  return distance;
}

}  // namespace

Standing check_standing(Plant plant, Progress& progress, const Vec3& gravity) {
  const MotionArray modelled = plant.motion;
  const StepOptions options{.dt = plant.scheme.dt, .gravity = gravity};
  const auto steps = [&](double seconds) { return static_cast<int>(std::ceil(seconds / options.dt)); };
  std::vector<Wrench> push(plant.particles.size());
  for (size_t i = 0; i < push.size(); ++i)
    push[i].force = 1e-3 * gravity.norm() * plant.particles[i].mass * Vec3(0.8, 0, 0.6);

  PlantStepper stepper;
  progress.begin("stand", static_cast<size_t>(steps(10) + steps(1) + steps(20)));
  // The farthest that any particle gets from where it was modelled.
  const auto farthest = [&](double seconds, std::span<const Wrench> external) {
    double distance = 0;
    for (int i = 0; i < steps(seconds); ++i) {
      progress.throw_if_cancelled();
      stepper.step(plant, external, {}, options);
      for (size_t p = 0; p < modelled.size(); ++p)
        distance = std::max(distance, (plant.motion[p].position - modelled[p].position).norm());
      progress.advance();
    }
    return distance;
  };
  Standing result;
  result.moved = farthest(10, {});
  plant.motion = modelled;
  farthest(1, push);
  const double early = farthest(5, {});
  farthest(10, {});
  // A fast fall is over within the first seconds, a slow one shows in the last.
  result.stable = farthest(5, {}) <= early && early < 0.1 * extent(modelled);
  return result;
}

}  // namespace liana
