// Plants that touch each other and themselves.
#include <gtest/gtest.h>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/check/frequency_probe.h"
#include "runtime/sim/contact/plant_contacts.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

const Quat kAlongX(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ())),
    kAlongZ(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));

/// One free particle: 20 cm long, 5 mm in radius.
Plant free_stick(const Vec3& position, const Quat& orientation, double mass, const Vec3& velocity) {
  Plant plant;
  plant.branches.resize(1);
  Particle particle;
  particle.branch = BranchId(0);
  particle.half_length = 0.1;
  particle.half_width = particle.half_thickness = 5e-3;
  particle.mass = mass;
  particle.inertia = rod_inertia(mass, 0.1, 5e-3, 5e-3);
  plant.particles.push_back(particle);
  plant.branches[0].particles.push_back(ParticleId(0));
  plant.motion.resize(1);
  plant.motion[0].position = position;
  plant.motion[0].orientation = orientation;
  plant.motion[0].velocity = velocity;
  return plant;
}

/// One free blade: 6 x 4 cm, 0.4 mm thick.
Plant free_blade(const Vec3& position, const Quat& orientation, double mass, const Vec3& velocity) {
  Plant plant = free_stick(position, orientation, mass, velocity);
  plant.branches[0].kind = DomainKind::Leaf;
  Particle& particle = plant.particles[0];
  particle.half_length = 0.03, particle.half_width = 0.02, particle.half_thickness = 2e-4;
  particle.inertia = rod_inertia(mass, 0.03, 0.02, 2e-4);
  return plant;
}

/// Plants that touch each other, stepped one after the other.
struct Together {
  std::vector<Plant> plants;
  PlantContacts contacts;
  std::vector<PlantStepper> steppers;
  Vec3 gravity = Vec3::Zero();
  double deepest = 0;
  size_t touched = 0, exempt = 0;

  void step(std::vector<std::vector<Wrench>> wrenches = {}) {
    steppers.resize(plants.size());
    wrenches.resize(plants.size());
    std::vector<std::vector<WorldSpring>> springs(plants.size());
    std::vector<const Plant*> all;
    std::vector<std::vector<WorldSpring>*> lists;
    for (size_t i = 0; i < plants.size(); ++i) all.push_back(&plants[i]), lists.push_back(&springs[i]);
    const PlantContactReport report = contacts.gather(all, lists);
    deepest = std::max(deepest, report.max_overlap);
    touched += report.contacts;
    exempt = report.exempt;
    StepOptions options;
    options.gravity = gravity;
    for (size_t i = 0; i < plants.size(); ++i)
      EXPECT_TRUE(steppers[i].step(plants[i], wrenches[i], springs[i], options).finite);
  }
  double energy() const {
    double sum = 0;
    for (const Plant& plant : plants)
      for (size_t i = 0; i < plant.particles.size(); ++i) {
        const Motion& m = plant.motion[i];
        const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
        sum += plant.particles[i].mass * m.velocity.squaredNorm() / 2 +
               spin.dot(plant.particles[i].inertia.cwiseProduct(spin)) / 2;
      }
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (const Plant& plant : plants)
      for (size_t i = 0; i < plant.particles.size(); ++i)
        sum += plant.particles[i].mass * plant.motion[i].velocity;
    return sum;
  }
};

TEST(PlantContacts, TwoFreeSticksThatMeetKeepTheirMomentum) {
  for (const double heavier : {1.0, 10.0, 300.0}) {
    for (const double restitution : {0.0, 0.5, 1.0}) {
      PlantContactOptions options;
      options.material.restitution = restitution;
      Together two;
      two.contacts = PlantContacts(options);
      two.plants.push_back(free_stick({0, 0.05, 0}, kAlongX, 0.01, {0, -1, 0}));
      two.plants.push_back(free_stick({0, 0, 0}, kAlongZ, 0.01 * heavier, {0, 0.5, 0}));
      const Vec3 before = two.momentum();
      for (int i = 0; i < 40; ++i) two.step();
      EXPECT_GT(two.touched, 0u);
      EXPECT_LT((two.momentum() - before).norm(), 1e-9 * 0.01) << heavier << " " << restitution;
      // [Haedrich17] §5.2: the relative speed of 1.5 m/s along the normal is multiplied by the restitution.
      const double leaving = (two.plants[0].motion[0].velocity - two.plants[1].motion[0].velocity).y();
      // An inelastic stop leaves the time step a lingering acceleration, worth a tenth.
      EXPECT_NEAR(leaving, 1.5 * restitution, restitution > 0 ? 0.03 : 0.15) << heavier;
    }
  }
}

TEST(PlantContacts, PressedTogetherTheyDoNotPass) {
  Together two;
  two.plants.push_back(free_stick({0, 0.0051, 0}, kAlongX, 0.01, {0, -0.02, 0}));
  two.plants.push_back(free_stick({0, -0.0051, 0}, kAlongZ, 0.01, Vec3::Zero()));
  const double force = 0.5;  // N: five times the weight of each
  for (int i = 0; i < 200; ++i) two.step({{{.force = {0, -force, 0}}}, {{.force = {0, force, 0}}}});
  // 10 times 5 g over the step squared is 80 N/m for a touch; at a quarter of the thickness it is 3.8 times
  // that, of which the time step takes 0.625: 0.47 N.
  const double depth = 0.01 - (two.plants[0].motion[0].position - two.plants[1].motion[0].position).y();
  EXPECT_GT(depth, 0);
  EXPECT_LT(depth, 5e-3);
  EXPECT_LT((two.plants[0].motion[0].velocity - two.plants[1].motion[0].velocity).norm(), 1e-5) << "at rest";
  EXPECT_LT(two.deepest, 8e-3) << "their axes never meet";
}

TEST(PlantContacts, AFastStickDoesNotPassAnother) {
  for (const double speed : {1.0, 5.0, 10.0}) {  // m/s; 10 m/s is 25 thicknesses in a step
    Together two;
    two.plants.push_back(free_stick({0.01, 0.37, 0.01}, kAlongX, 0.01, {0, -speed, 0}));
    two.plants.push_back(free_stick({0, 0, 0}, kAlongZ, 0.1, Vec3::Zero()));
    for (Plant& plant : two.plants) plant.particles[0].inertia *= 1e4;  // they do not swing round each other
    for (int i = 0; i < 60; ++i) two.step();
    EXPECT_GT((two.plants[0].motion[0].position - two.plants[1].motion[0].position).y(), 0) << speed;
  }
}

/// A held horizontal twig and another that crosses it 1 cm above and is let go.
Together crossing_twigs() {
  Together two;
  const Bake bake = test::rod_bake({.length = 0.6, .radius = 0.006, .frequency = 1.5, .damping_factor = 0.3});
  for (const int i : {0, 1}) {
    PlacementOptions placement;
    placement.position = {i == 0 ? 0.0 : 0.017, 0, 0};
    two.plants.push_back(make_plant(bake, placement));
  }
  return two;
}

TEST(PlantContacts, ARodPushedAgainstItsNeighbourBendsIt) {
  Together two = crossing_twigs();
  two.gravity = {0, -9.81, 0};
  const size_t tip = two.plants[0].particles.size() - 1;
  std::vector<Wrench> push(two.plants[0].particles.size());
  push[tip].force = {0.3, 0, 0};
  double closest = 1;
  for (int i = 0; i < 2400; ++i) {
    two.step({push, {}});
    if (i > 1200)
      closest =
          std::min(closest, (two.plants[1].motion[tip].position - two.plants[0].motion[tip].position).x());
  }
  EXPECT_GT(two.touched, 100u);
  EXPECT_GT(two.plants[1].motion[tip].position.x(), 0.03) << "the neighbour is pushed aside";
  EXPECT_GT(closest, 0.006) << "and not passed: radii of 6 mm each";
  EXPECT_LT(two.plants[0].motion[tip].velocity.norm(), 1e-3) << "they come to rest";
}

TEST(PlantContacts, ALastingContactPushesBothAlike) {
  // What holds the two rods at rest is at their supports: the contact's two springs must balance.
  Together two = crossing_twigs();
  two.gravity = {0, -9.81, 0};
  const size_t tip = two.plants[0].particles.size() - 1;
  std::vector<Wrench> push(two.plants[0].particles.size());
  push[tip].force = {0.3, 0, 0};
  for (int i = 0; i < 2400; ++i) two.step({push, {}});
  std::vector<WorldSpring> springs[2];
  const Plant* plants[] = {&two.plants[0], &two.plants[1]};
  std::vector<WorldSpring>* lists[] = {&springs[0], &springs[1]};
  two.contacts.gather(plants, lists);
  Vec3 sum = Vec3::Zero(), largest = Vec3::Zero();
  for (int k = 0; k < 2; ++k)
    for (const WorldSpring& s : springs[k]) {
      const Motion& m = plants[k]->motion[s.particle.index()];
      const Vec3 x = m.position + m.orientation * s.on_particle;
      const Vec3 force = s.stiffness * (s.target - x);
      sum += force;
      largest = largest.cwiseMax(force.cwiseAbs());
    }
  ASSERT_GT(largest.x(), 0.02) << "N";
  EXPECT_LT(sum.norm(), 0.05 * largest.norm()) << "what is left is their last slow motion";
}

TEST(PlantContacts, WhatOverlapsWhenMadeIsLeftAloneUntilItComesApart) {
  Together two;
  two.plants.push_back(free_stick({0, 0.004, 0}, kAlongX, 0.01, Vec3::Zero()));
  two.plants.push_back(free_stick({0, 0, 0}, kAlongZ, 0.01, Vec3::Zero()));
  two.step();
  EXPECT_EQ(two.exempt, 1u);
  EXPECT_EQ(two.touched, 0u);
  two.plants[0].motion[0].position.y() = 0.02;
  two.step();
  EXPECT_EQ(two.exempt, 0u);
  two.plants[0].motion[0].position.y() = 0.0099;
  two.step();
  EXPECT_EQ(two.touched, 1u);
}

TEST(PlantContacts, AFreeTreeMovesAsWithoutThem) {
  // Not near: no kin, no overlap as grown, nothing else. The same bits.
  const Plant start = make_plant(test::synthetic_bake({.branches = 3}));
  Together with;
  with.plants = {start};
  with.gravity = {0, -9.81, 0};
  PlantStepper alone;
  Plant without = start;
  for (auto* plant : {&with.plants[0], &without})
    for (Motion& m : plant->motion) m.velocity.x() = 0.02 * m.position.y();
  for (int i = 0; i < 200; ++i) {
    with.step();
    alone.step(without, {}, {}, {});
  }
  EXPECT_EQ(with.touched, 0u);
  EXPECT_EQ(state_hash(with.plants[0], 0), state_hash(without, 0));
}

const Quat kFlat(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));  // a blade's upper side is up

/// A leaf of 6 x 4 cm on the tip of a petiole of its own, held at `base`, reaching along +X, face up.
Plant held_leaf(const Vec3& base, double yaw) {
  Plant plant = test::rod_plant({.length = 0.06,

                                 .radius = 0.02,
                                 .youngs_modulus = 1.4e7,
                                 .density = 400,
                                 .flatness = 100},
                                1);
  plant.branches[0].kind = DomainKind::Leaf;
  plant.particles[0].mass_damping = 2.5;
  const Quat turn =
      Quat(Eigen::AngleAxisd(yaw, Vec3::UnitY())) * kAlongX * Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));
  Joint& joint = plant.particles[0].joint;
  joint.on_parent = base;
  joint.rest = turn;
  plant.motion[0].orientation = turn;
  plant.motion[0].position = base - turn * joint.on_self;
  return plant;
}

TEST(PlantContacts, ALeafPressedOnAnotherBendsItAndComesToRest) {
  for (const double yaw : {0.0, 0.5, kPi / 2, kPi}) {
    Together two;
    two.plants.push_back(held_leaf({0, 0.004, 0}, 0));
    const Quat turn(Eigen::AngleAxisd(yaw, Vec3::UnitY()));
    two.plants.push_back(held_leaf(Vec3(0.04, 0, 0) - turn * Vec3(0.03, 0, 0), yaw));
    const double force = 0.3 * two.plants[0].particles[0].joint.bend_stiffness.x() / 0.03;  // 0.3 rad alone
    for (int i = 0; i < 400; ++i) two.step({{{.force = {0, -force, 0}}}, {}});
    const Motion &upper = two.plants[0].motion[0], &lower = two.plants[1].motion[0];
    EXPECT_LT(lower.position.y(), -0.001) << yaw;
    EXPECT_LT(lower.position.y(), upper.position.y()) << yaw;
    EXPECT_LT(upper.velocity.norm(), 2e-3) << yaw << ": trembles by 50 um";
  }
}

TEST(PlantContacts, TwoFreeBladesThatMeetLoseEnergyAndKeepTheirMomentum) {
  for (const double aside : {0.0, 0.005})
    for (const double heavier : {1.0, 10.0}) {
      Together two;
      const Quat tilted = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ())) * kFlat;
      two.plants.push_back(free_blade({aside, 0.02, 0}, kFlat, 3e-4, {0, -0.5, 0}));
      two.plants.push_back(
          free_blade({0, -0.02, 0}, aside > 0 ? tilted : kFlat, 3e-4 * heavier, {0, 0.5, 0}));
      const Vec3 before = two.momentum();
      const double energy = two.energy();
      for (int i = 0; i < 40; ++i) two.step();
      EXPECT_LT(two.energy(), energy) << aside << " " << heavier;
      EXPECT_GT(two.touched, 0u);
      if (aside == 0) {
        EXPECT_LT((two.momentum() - before).norm(), 1e-9 * 3e-4) << heavier;
      }
      const Vec3 apart = two.plants[0].motion[0].velocity - two.plants[1].motion[0].velocity;
      EXPECT_GT(apart.y(), -0.2) << "of 1 m/s";
    }
}

TEST(PlantContacts, AFastBladeDoesNotPassABladeOrAStem) {
  for (const bool stem : {false, true})
    for (const double speed : {0.5, 1.0}) {  // m/s: 25 mm in a step
      Together two;
      two.plants.push_back(free_blade({0.004, 0.31, 0.003}, kFlat, 3e-4, {0, -speed, 0}));
      two.plants.push_back(stem ? free_stick({0, 0, 0}, kAlongZ, 0.1, Vec3::Zero())
                                : free_blade({0, 0, 0}, kFlat, 0.1, Vec3::Zero()));
      for (Plant& plant : two.plants)
        plant.particles[0].inertia *= 1e4;  // they do not swing round each other
      for (int i = 0; i < 60; ++i) two.step();
      EXPECT_GT(two.touched, 0u);
      EXPECT_GT((two.plants[0].motion[0].position - two.plants[1].motion[0].position).y(), 0)
          << speed << " " << stem;
    }
}

TEST(PlantContacts, ABladeThatWasPiercedComesOffAtTheSideItCameFrom) {
  // Pushed through a stem by its tip and let go.
  Together two;
  two.plants.push_back(free_stick({0, 0, 0}, kAlongZ, 0.1, Vec3::Zero()));
  two.plants.push_back(free_blade({0, 0.04, 0}, Quat::Identity(), 3e-4, Vec3::Zero()));
  two.step();
  two.plants[1].motion[0].position.y() = 0.02;  // its tip is 10 mm below the stem's axis
  for (int i = 0; i < 100; ++i) two.step();
  EXPECT_GT(two.touched, 0u);
  EXPECT_GT(two.plants[1].motion[0].position.y(), 0.033) << "its half length, and the stem's radius of 5 mm";
}

TEST(PlantContacts, NothingIsTooSmallTooLightOrTooNear) {
  Together two;
  two.plants.push_back(free_blade(Vec3::Zero(), kFlat, 3e-4, {0, -1, 0}));
  two.plants.push_back(free_blade({0, -0.004, 0}, kFlat, 3e-4, Vec3::Zero()));
  two.step();
  Particle& small = two.plants[1].particles[0];
  small.half_width = small.half_thickness = 0;
  small.mass = 0;
  small.inertia.setZero();
  two.plants[1].motion[0].position = two.plants[0].motion[0].position;
  std::vector<WorldSpring> springs[2];
  const Plant* plants[] = {&two.plants[0], &two.plants[1]};
  std::vector<WorldSpring>* lists[] = {&springs[0], &springs[1]};
  two.contacts.gather(plants, lists);
  ASSERT_EQ(springs[0].size() + springs[1].size(), 2u);
  for (const auto& list : springs)
    for (const WorldSpring& s : list) EXPECT_TRUE(s.stiffness.allFinite() && s.target.allFinite());
}

TEST(PlantContacts, NeighboursAreFoundWhateverTheirSizes) {
  // Against all pairs, one by one.
  std::vector<Aabb> boxes;
  uint32_t state = 1;
  const auto random = [&] {
    return static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
  };
  for (int i = 0; i < 600; ++i) {
    const Aabb::Corner centre{random(), random(), random(), 0};
    const float half = i % 100 == 0 ? 0.4f : 0.01f + 0.03f * random();
    boxes.push_back({centre - half, centre + half});
  }
  const auto overlap = [](const Aabb& a, const Aabb& b) {
    for (int axis = 0; axis < 3; ++axis)
      if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
    return true;
  };
  // Numbers of boxes that fill no level of the tree, too.
  for (const size_t count : {size_t{0}, size_t{1}, size_t{5}, size_t{77}, boxes.size()}) {
    const std::span some(boxes.data(), count);
    std::vector<std::pair<uint32_t, uint32_t>> found, asked, expected;
    AabbTree finder;
    finder.fit(some);
    finder.pairs([&](uint32_t a, uint32_t b) { found.emplace_back(a, b); });
    for (uint32_t i = 0; i < count; ++i) {
      finder.overlaps_of(i, [&](uint32_t other) {
        if (i < other) asked.emplace_back(i, other);
      });
      for (uint32_t j = i + 1; j < count; ++j)
        if (overlap(boxes[i], boxes[j])) expected.emplace_back(i, j);
    }
    std::sort(found.begin(), found.end());
    std::sort(asked.begin(), asked.end());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(asked, expected);
    EXPECT_EQ(expected.size() > 1000, count == boxes.size());
  }
}

}  // namespace
}  // namespace liana
