#include "tests/support/scenes/climber_scene.h"

#include <algorithm>

#include "mesher/base/stopwatch.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/wind/field/wind_forces.h"

namespace liana {
namespace {

const Vec3 kToSun(0.4, 0.8, 0.45);

}  // namespace

SpeciesLaw ivy_like_law() {
  SpeciesLaw law;
  law.species = "ivy-like";
  law.default_material = {3e9, 800, 0.3};
  const DampingLaw stem{0.5, 4, 0.06, 0.12, 2, 2};
  law.groups["level0"] = {0.7, 1.0, -0.59, 1, 0, stem};
  law.groups["level1"] = {1.1, 0.5, -0.59, 1, 0, stem};
  law.groups["level2"] = {1.7, 0.25, -0.59, 1, 0, stem};
  law.groups["leaf"] = {4.0, 0.09, -0.59, 0.83, 0, {2, 8, 0.12, 0.25, 2, 2}};
  return law;
}

ClimberScene::ClimberScene(const ClimberParameters& parameters, uint64_t seed)
    : wall(box_mesh({-2.5, -0.1, -0.2}, {2.5, 3, 0})),
      climber(parameters, ivy_like_law(), {0, 0, 0.12}, seed) {}

void ClimberScene::step(const WindField* wind) {
  const double dt = plant.scheme.dt;
  seconds.growth += timed([&] { growth = climber.grow(plant, obstacles(), kToSun, growth_speed * dt); });
  springs_.clear();
  seconds.wind += timed([&] {
    if (wind) add_wind(plant, *wind, time, {}, springs_);
  });
  seconds.physics += timed([&] {
    StepOptions options;
    options.dt = dt;
    const ContactStepReport report = stepper.step(plant, collision(), {}, springs_, options);
    max_penetration = std::max(max_penetration, report.contacts.max_penetration);
    contact_springs += report.contacts.contacts;
    sound = sound && report.step.finite && report.step.gap_held;
    redone += report.step.redone;
    passes += report.passes;
    seconds.collision += report.collision_seconds;
  });
  out_of_range += growth.out_of_range;
  recalibrated += growth.recalibrated;
  for (const Motion& motion : plant.motion) max_speed = std::max(max_speed, motion.velocity.norm());
  time += dt;
}

void ClimberScene::run(double duration, const WindField* wind) {
  for (double end = time + duration - 1e-9; time < end;) step(wind);
}

}  // namespace liana
