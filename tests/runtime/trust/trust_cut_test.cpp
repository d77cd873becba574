// Cutting and breaking: nothing jumps at that moment, and afterwards only as the load tells that is gone.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/breaking.h"
#include "runtime/sim/model/rotation.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/time_step.h"
#include "runtime/world/world.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/busy_scene.h"

namespace liana {
namespace {

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // about the origin
  double size = 0, turning = 0;                        // sums of magnitudes, for tolerances
};

void add(const Plant& plant, ParticleId id, Momenta& sum) {
  const Particle& p = plant.particles[id.index()];
  const Motion& m = plant.motion[id.index()];
  const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
  const Vec3 linear = p.mass * m.velocity,
             angular = m.position.cross(linear) + m.orientation * p.inertia.cwiseProduct(spin).eval();
  sum.linear += linear, sum.angular += angular;
  sum.size += linear.norm(), sum.turning += angular.norm();
}

Momenta momenta(const Plant& plant) {
  Momenta sum;
  for (size_t i = 0; i < plant.particles.size(); ++i) add(plant, ParticleId(i), sum);
  return sum;
}

/// What a part pulls at its parent with in a step, about the parent's centre: by the motion that its own
/// particles make of it, since a stiff joint's strain does not tell. As the step balances it: generalised-α,
/// m
/// ((1 − α_m) a' + α_m a) = force, at the places and in the directions of a prediction without a'.
Wrench load_on_parent(const Plant& before, const Plant& after, const std::vector<ParticleId>& part) {
  const double h = before.scheme.dt;
  const GeneralizedAlpha method(before.scheme.rho_infinity);
  const double t = (1 - method.alpha_f) * h, t2 = t * h * (0.5 - method.beta);
  const auto mix = [](double alpha, const Vec3& was, const Vec3& is) -> Vec3 {
    return (1 - alpha) * is + alpha * was;
  };
  const auto place = [&](ParticleId id) -> Vec3 {
    const Motion& m = before.motion[id.index()];
    return m.position + t * m.velocity + t2 * m.acceleration;
  };
  const Vec3 centre = place(before.particles[part.front().index()].parent);
  Wrench load;
  for (const ParticleId id : part) {
    const Particle& p = before.particles[id.index()];
    const Motion &m = before.motion[id.index()], &n = after.motion[id.index()];
    const Vec3 turn = t * m.angular_velocity + t2 * m.angular_acceleration;
    const Mat3 R = (rotation_exp(turn) * m.orientation).toRotationMatrix();
    const Vec3 force = p.mass * (mix(method.alpha_m, m.acceleration, n.acceleration) - Vec3(0, -9.81, 0) +
                                 p.mass_damping * mix(method.alpha_f, m.velocity, n.velocity));
    const Vec3 spin_up = mix(method.alpha_m, m.angular_acceleration, n.angular_acceleration) +
                         p.mass_damping * mix(method.alpha_f, m.angular_velocity, n.angular_velocity);
    load.force -= force;
    load.torque -= R * p.inertia.cwiseProduct(R.transpose() * spin_up) + (place(id) - centre).cross(force);
  }
  return load;
}

bool same(const Motion& a, const Motion& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs() &&
         a.velocity == b.velocity && a.angular_velocity == b.angular_velocity;
}

class SwingingTree : public ::testing::Test {
 protected:
  SwingingTree() : plant_(make_plant(test::synthetic_bake({.branches = 6, .twigs = 2, .leaves = 3}))) {
    const std::vector<Wrench> wind(plant_.particles.size(), {.force = {6e-3, 0, 3e-3}});
    for (int i = 0; i < 60; ++i) stepper_.step(plant_, wind, {}, {});
    for (int i = 0; i < 15; ++i) stepper_.step(plant_, {}, {}, {});
    Plant swings = plant_;
    PlantStepper stepper;
    fastest_.assign(plant_.motion.size(), 0);
    for (int i = 0; i < 80; ++i) {
      stepper.step(swings, {}, {}, {});
      for (size_t k = 0; k < fastest_.size(); ++k)
        fastest_[k] = std::max(fastest_[k], swings.motion[k].velocity.norm());
    }
  }
  /// Cuts, and gives what stays the load that it lost, for one step: the largest difference of a tip's
  /// velocity to that of the plant left whole, over the fastest it swings. `lost`: the same without the load.
  double jump(ParticleId cut, double* lost = nullptr) const {
    Plant whole = plant_, held = plant_;
    PlantStepper().step(whole, {}, {}, {});
    Remap change;
    DetachedFrom from;
    detach_subtree(held, cut, &change, &from);
    Plant bare = held;
    const ParticleId at = plant_.particles[cut.index()].parent;
    std::vector<Wrench> load(held.particles.size());
    load[change.particles[at.index()].index()] = load_on_parent(plant_, whole, from.particles);
    PlantStepper().step(held, load, {}, {});
    PlantStepper().step(bare, {}, {}, {});
    double worst = 0;
    for (const Branch& branch : plant_.branches) {
      const ParticleId tip = branch.particles.back(), now = change.particles[tip.index()];
      if (!now.valid()) continue;
      const Vec3 before = whole.motion[tip.index()].velocity;
      worst = std::max(worst, (held.motion[now.index()].velocity - before).norm() / fastest_[tip.index()]);
      if (lost)
        *lost = std::max(*lost, (bare.motion[now.index()].velocity - before).norm() / fastest_[tip.index()]);
    }
    return worst;
  }

  Plant plant_;
  PlantStepper stepper_;
  std::vector<double> fastest_;  // m/s, of each particle in the two seconds that come
};

TEST_F(SwingingTree, NothingMovesAtTheMomentOfACut) {
  for (size_t b = 1; b < plant_.branches.size(); b += 3) {
    const ParticleId root = plant_.branches[b].particles[plant_.branches[b].particles.size() / 2];
    Plant cut = plant_;
    Remap change;
    DetachedFrom from;
    const Plant piece = detach_subtree(cut, root, &change, &from);
    for (size_t i = 0; i < plant_.motion.size(); ++i) {
      if (!change.particles[i].valid()) continue;
      EXPECT_TRUE(same(cut.motion[change.particles[i].index()], plant_.motion[i])) << i;
    }
    Momenta before;
    for (const ParticleId id : from.particles) add(plant_, id, before);
    const Momenta after = momenta(piece);
    ASSERT_GT(before.size, 0);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.size);
    EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * before.turning);
  }
}

TEST_F(SwingingTree, WhatStaysFeelsTheLostLoadAndNothingElse) {
  double worst = 0, lost = 0;
  size_t cuts = 0;
  for (const Branch& branch : plant_.branches)
    for (const size_t k : {size_t{0}, branch.particles.size() / 2}) {
      if (!branch.parent.valid()) continue;
      worst = std::max(worst, jump(branch.particles[k], &lost));
      ++cuts;
    }
  EXPECT_GT(cuts, 100u);
  EXPECT_LT(worst, 1e-9) << "rounding of stiff joints, some 1e-12";
  EXPECT_GT(lost, 0.1) << "the load does matter";
}

TEST_F(SwingingTree, WhatBreaksOffTakesNothingButItsLoadAway) {
  double stress = 0;
  for (size_t i = 1; i < plant_.particles.size(); ++i)
    stress = std::max(stress, joint_stress(plant_, ParticleId(i)));
  for (Branch& branch : plant_.branches) branch.strength = branch.parent.valid() ? stress / 3 : 0;
  std::vector<Fracture> found;
  find_fractures(plant_, 8, found);
  ASSERT_GT(found.size(), 2u);
  for (const Fracture& fracture : found) EXPECT_LT(jump(fracture.at), 1e-9);
}

Momenta momenta(const World& world) {
  Momenta all;
  for (size_t p = 0; p < world.plant_count(); ++p)
    for (size_t i = 0; i < world.plant(p).particles.size(); ++i) add(world.plant(p), ParticleId(i), all);
  return all;
}

// The same scene with and without a strength, until something breaks at the end of a step.
TEST(BreakingScene, KeepsAllMomentaInTheStepInWhichItBreaks) {
  const ScratchFolder folder;
  Scene scene = test::busy_scene(folder);
  scene.climbers.clear();
  scene.wind.air.reset();
  scene.wind.velocity = {25, 0, -8};
  World breaks(scene, 1);
  for (ScenePlant& plant : scene.plants) plant.breaking = 0;
  World holds(scene, 1);
  while (breaks.report().broken + breaks.report().shed == 0 && breaks.report().steps < 200)
    breaks.step(), holds.step();
  ASSERT_GT(breaks.report().broken + breaks.report().shed, 0u);
  ASSERT_GT(breaks.plant_count(), holds.plant_count());
  const Momenta apart = momenta(breaks), whole = momenta(holds);
  EXPECT_LT((apart.linear - whole.linear).norm(), 1e-12 * whole.size);
  EXPECT_LT((apart.angular - whole.angular).norm(), 1e-12 * whole.turning);
  breaks.step(), holds.step();
  EXPECT_GT((momenta(breaks).angular - momenta(holds).angular).norm(), 1e-9 * whole.turning)
      << "from then on they differ";
}

}  // namespace
}  // namespace liana
