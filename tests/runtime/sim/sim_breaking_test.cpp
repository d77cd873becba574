#include <gtest/gtest.h>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/model/breaking.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/climber_scene.h"

namespace liana {
namespace {

constexpr double kGravity = 9.81;

double energy(const Plant& plant) {
  double sum = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum += p.mass * (m.velocity.squaredNorm() / 2 + kGravity * m.position.y()) +
           p.inertia.dot(spin.cwiseAbs2()) / 2 + joint_energy(plant, ParticleId(i));
  }
  return sum;
}

Vec3 momentum(const Plant& plant) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < plant.particles.size(); ++i)
    sum += plant.particles[i].mass * plant.motion[i].velocity;
  return sum;
}

Plant swaying_tree() {
  Plant plant = make_plant(test::synthetic_bake({.branches = 4}));
  PlantStepper stepper;
  const std::vector<Wrench> wind(plant.particles.size(), {.force = {4e-3, 0, 2e-3}});
  for (int i = 0; i < 30; ++i) stepper.step(plant, wind, {}, {});
  return plant;
}

// The n-th branch on the trunk, from 1.
const Branch& limb(const Plant& plant, int n) {
  for (const Branch& branch : plant.branches)
    if (branch.level == 1 && branch.kind == DomainKind::Branch && --n == 0) return branch;
  throw std::runtime_error("no such limb");
}

TEST(Cantilever, BreaksAtItsRootWhereMcOverIIsItsStrength) {
  const test::RodShape shape{.length = 1, .radius = 0.01};
  for (const int particles : {4, 20}) {
    Plant rod = test::rod_plant(shape, particles);
    rod.branches[0].strength = 1e7;
    const double tip = shape.length * (1 - 0.5 / particles);  // m: loads act at a particle's centre
    const double section_modulus = kPi / 4 * std::pow(shape.radius, 3);
    const double breaking = rod.branches[0].strength * section_modulus / tip;  // N
    PlantStepper stepper;
    std::vector<Wrench> load(rod.particles.size());
    std::vector<Fracture> found;
    double force = 0;
    for (int i = 1; found.empty() && force < 2 * breaking; ++i) {
      force = 1.2 * breaking * i / 800;  // over 20 s; it swings at 10 Hz
      load.back().force = {force, 0, 0};
      stepper.step(rod, load, {}, {.gravity = Vec3::Zero()});
      find_fractures(rod, 8, found);
    }
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].at, ParticleId(0)) << particles;
    // The tip moves 4 cm to the side and by 0.1 % down; a step of the ramp is 0.15 %.
    EXPECT_NEAR(force / breaking, 1, 0.01) << particles;
  }
}

TEST(JointStress, IsThatOfTensionAndOfBendingOverBothAxes) {
  const test::RodShape shape{.length = 0.5, .radius = 0.005, .flatness = 2};
  const auto stress = [&](const Wrench& at_tip) {
    Plant rod = test::rod_plant(shape, 5);
    for (Particle& p : rod.particles) p.stiffness_damping = 0.01;
    std::vector<Wrench> load(rod.particles.size());
    load.back() = at_tip;
    PlantStepper stepper;
    for (int i = 0; i < 400; ++i) stepper.step(rod, load, {}, {.gravity = Vec3::Zero()});
    return std::pair{joint_stress(rod, ParticleId(0)), joint_stress(rod, ParticleId(4))};
  };
  const Particle section = test::rod_plant(shape, 5).particles[0];
  const double a = section.half_width, b = section.half_thickness;
  ASSERT_GT(a, 1.5 * b);
  const double tension = 100 / (kPi * a * b), about_x = 0.05 / (kPi / 4 * a * b * b),
               about_z = 0.05 / (kPi / 4 * a * a * b);
  // A moment at the tip is the same in every section.
  for (const double s : {stress({{0, 100, 0}, {0, 0, 0}}).first, stress({{0, 100, 0}, {0, 0, 0}}).second})
    EXPECT_NEAR(s, tension, 1e-3 * tension);
  for (const double s : {stress({{0, 0, 0}, {0.05, 0, 0}}).first, stress({{0, 0, 0}, {0.05, 0, 0}}).second})
    EXPECT_NEAR(s, about_x, 5e-3 * about_x);
  for (const double s : {stress({{0, 0, 0}, {0, 0, 0.05}}).first, stress({{0, 0, 0}, {0, 0, 0.05}}).second})
    EXPECT_NEAR(s, about_z, 5e-3 * about_z);
  EXPECT_NEAR(stress({{0, 0, 0}, {0.05, 0, 0.05}}).first, std::hypot(about_x, about_z), 0.02 * about_x);
}

TEST(Breaking, TakesTheEnergyOfTheJointAndChangesNoMomentum) {
  Plant plant = swaying_tree();
  for (const int branch : {3, 2, 1}) {
    const ParticleId cut = limb(plant, branch).particles[1];
    const double before = energy(plant), lost = joint_energy(plant, cut);
    const Vec3 moved = momentum(plant);
    const Plant piece = detach_subtree(plant, cut);
    EXPECT_GT(lost, 0);
    EXPECT_NEAR(energy(plant) + energy(piece), before - lost, 1e-9 * std::abs(before));
    EXPECT_LT((momentum(plant) + momentum(piece) - moved).norm(), 1e-12);
  }
}

TEST(Breaking, InjectsNoEnergyAfterwards) {
  // Steps so fine that what a step takes for a mode's energy is off by (ωh)²/4 < 1 % of it, leaves at 11 Hz.
  PlacementOptions fine;
  fine.scheme.dt = 0.0025;
  Plant plant = make_plant(test::synthetic_bake({.branches = 4}), fine);
  const StepOptions options{.dt = fine.scheme.dt};
  PlantStepper a, b;
  const std::vector<Wrench> wind(plant.particles.size(), {.force = {4e-3, 0, 2e-3}});
  for (int i = 0; i < 200; ++i) a.step(plant, wind, {}, options);
  double strain = 0;  // J
  for (size_t i = 0; i < plant.particles.size(); ++i) strain += joint_energy(plant, ParticleId(i));
  const double before = energy(plant);
  Plant piece = detach_subtree(plant, limb(plant, 1).particles[0]);
  for (int i = 0; i < 400; ++i) {
    a.step(plant, {}, {}, options), b.step(piece, {}, {}, options);
    ASSERT_LE(energy(plant) + energy(piece), before + 0.01 * strain) << "step " << i << " of " << strain;
  }
  EXPECT_LT(energy(plant) + energy(piece), before);
}

TEST(Breaking, PartFallsLandsAndRests) {
  Plant plant = swaying_tree();
  Plant piece = detach_subtree(plant, limb(plant, 3).particles[0]);
  double mass = 0;
  for (const Particle& p : piece.particles) mass += p.mass;
  const auto centre = [&] {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < piece.particles.size(); ++i)
      sum += piece.particles[i].mass / mass * piece.motion[i].position;
    return sum;
  };
  const Vec3 start = centre(), speed = momentum(piece) / mass;
  ContactStepper stepper;
  const auto step = [&] {
    std::vector<WorldSpring> springs;
    return stepper.step(piece, {{}, 0.0}, {}, springs, {.dt = piece.scheme.dt});
  };
  for (int i = 0; i < 12; ++i) step();
  const double t = 12 * piece.scheme.dt;
  // The joint's force fades over the first step: at most a step's fall, 2.5 % of 0.3 s.
  EXPECT_NEAR((centre() - start - t * speed).y() / (-kGravity * t * t / 2), 1, 0.1);
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(step().step.finite);
  double lowest = 1, fastest = 0, highest = 0;
  for (const Motion& m : piece.motion) {
    lowest = std::min(lowest, m.position.y()), highest = std::max(highest, m.position.y());
    fastest = std::max(fastest, m.velocity.norm());
  }
  EXPECT_GT(lowest, -5e-3);
  EXPECT_LT(highest, 0.8) << "it lies";
  EXPECT_LT(fastest, 0.02) << "it rests";
}

TEST(Fractures, OfTwoInOnePathOnlyTheWorseBreaks) {
  Plant plant = swaying_tree();
  for (Branch& branch : plant.branches) branch.strength = 1;  // everything is overloaded
  std::vector<Fracture> found;
  find_fractures(plant, 1000, found);
  ASSERT_FALSE(found.empty());
  std::vector<bool> broken(plant.particles.size());
  for (const Fracture& f : found) broken[f.at.index()] = true;
  for (const Fracture& f : found)
    for (ParticleId p = plant.particles[f.at.index()].parent; p.valid();
         p = plant.particles[p.index()].parent)
      EXPECT_FALSE(broken[p.index()]);
  for (size_t k = 1; k < found.size(); ++k) EXPECT_GE(found[k - 1].stress, found[k].stress);
  find_fractures(plant, 2, found);
  EXPECT_EQ(found.size(), 2u);
}

TEST(Fractures, SensitivityScalesTheModulusOfRuptureAndZeroDisables) {
  Bake bake = test::synthetic_bake({.branches = 2});
  bake.law = ivy_like_law();
  for (auto& [name, group] : bake.law.groups) group.modulus_of_rupture = 5e7;
  Plant plant = make_plant(bake);
  EXPECT_EQ(set_strengths(plant, bake.law, 1), 0u);
  EXPECT_EQ(plant.branches[0].strength, 5e7);
  set_strengths(plant, bake.law, 0.5);
  EXPECT_EQ(plant.branches[0].strength, 1e8);
  set_strengths(plant, bake.law, 0);
  for (Motion& m : plant.motion) m.orientation = m.orientation * Quat(Eigen::AngleAxisd(1, Vec3::UnitX()));
  std::vector<Fracture> found;
  find_fractures(plant, 8, found);
  EXPECT_TRUE(found.empty());
  EXPECT_GT(joint_stress(plant, limb(plant, 1).particles[1]), 0);
}

}  // namespace
}  // namespace liana
