#include "runtime/wind/air/plant_coupling.h"

#include <gtest/gtest.h>

#include "mesher/base/hash.h"
#include "mesher/base/random.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/wind/air/sph_wind.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

constexpr double kStep = 0.025;

/// Free ellipsoids of these half axes (across, along y, thick), a leaf or a piece of stem each.
Plant loose(DomainKind kind, const Vec3& half_axes, double density, const std::vector<Vec3>& places) {
  Plant plant;
  plant.branches.resize(1);
  plant.branches[0].kind = kind;
  for (size_t i = 0; i < places.size(); ++i) {
    Particle particle;
    particle.branch = BranchId(0);
    particle.half_width = half_axes.x(), particle.half_length = half_axes.y(),
    particle.half_thickness = half_axes.z();
    particle.mass = density * 4 * kPi / 3 * half_axes.prod();
    particle.inertia = rod_inertia(particle.mass, half_axes.y(), half_axes.x(), half_axes.z());
    plant.particles.push_back(particle);
    plant.branches[0].particles.push_back(ParticleId(i));
    plant.motion.push_back({});
    plant.motion.back().position = places[i];
  }
  return plant;
}

AirOptions air_options(double spacing = 0.1) {
  AirOptions options;
  options.low = Vec3::Constant(-6), options.high = Vec3::Constant(6);
  options.spacing = spacing;
  options.sound_speed = 12;
  options.viscosity = 0.01;
  return options;
}

/// A cube of air about the origin that moves as one.
void fill(SphAir& air, double half, const Vec3& velocity) {
  const double s = air.options().spacing;
  const int n = int(half / s);
  for (int x = -n; x <= n; ++x)
    for (int y = -n; y <= n; ++y)
      for (int z = -n; z <= n; ++z) ASSERT_TRUE(air.add(s * (Vec3(x, y, z) + Vec3::Constant(0.3)), velocity));
  air.sort();
}

/// Air and one plant without gravity, step by step.
struct Meeting {
  SphAir air;
  Plant plant;
  std::vector<uint8_t> growing;
  PlantCoupling coupling{air};
  PlantStepper stepper;
  std::vector<WorldSpring> springs;
  std::vector<Wrench> wrenches;
  Vec3 drag = Vec3::Zero(), pressure = Vec3::Zero();  // N·s, all that the plant got

  Meeting(const AirOptions& options, Plant p) : air(options), plant(std::move(p)) {}

  void step(bool plant_moves = true, const WindField* ambient = nullptr) {
    const PlantInWind in{&plant, growing};
    const std::span<AirBody> bodies = coupling.set_bodies({&in, 1});
    const int parts = int(std::ceil(kStep / air.longest_step()));
    for (int part = 0; part < parts; ++part) air.step(kStep / parts, bodies);
    air.sort();
    coupling.find({&in, 1}, ambient, 0, kStep);
    springs.clear();
    coupling.dashpots(0, plant, springs);
    wrenches.assign(plant.particles.size(), {});
    coupling.add_pressure(0, wrenches);
    for (const Wrench& w : wrenches) pressure += kStep * w.force;
    StepOptions options;
    options.gravity = Vec3::Zero();
    if (plant_moves) stepper.step(plant, wrenches, springs, options);
    coupling.react({&in, 1});
    drag += coupling.exchanged();
  }
  Vec3 plant_momentum() const {
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < plant.particles.size(); ++i)
      sum += plant.particles[i].mass * plant.motion[i].velocity;
    return sum;
  }
};

std::vector<Vec3> places(int n, double spread) {
  Random random(11, "test");
  std::vector<Vec3> all;
  for (int i = 0; i < n; ++i)
    all.push_back(spread * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  return all;
}

TEST(PlantCoupling, WhatLeavesGainTheAirLoses) {
  Meeting meeting(air_options(), loose(DomainKind::Leaf, {0.03, 0.04, 2e-4}, 600, places(200, 0.3)));
  fill(meeting.air, 0.6, {0.5, 0, 3});
  const Vec3 before = meeting.air.momentum();
  for (int i = 0; i < 24; ++i) meeting.step();
  const Vec3 gained = meeting.plant_momentum(), lost = before - meeting.air.momentum();
  EXPECT_EQ(meeting.air.left(), 0u);
  EXPECT_GT(gained.norm(), 0.03 * before.norm()) << "enough changed hands to be measured";
  EXPECT_LT((gained - lost).norm(), 1e-3 * gained.norm());
  // The leaves have nearly the air's velocity by now, which the step's own memory of forces needs to vanish.
  EXPECT_LT((gained - meeting.drag - meeting.pressure).norm(), 1e-3 * gained.norm());
}

TEST(PlantCoupling, WhatThickBodiesGainByPressureTheAirLoses) {
  Meeting meeting(air_options(), loose(DomainKind::Branch, {0.08, 0.15, 0.08}, 5, {{0.5, 0, 0}}));
  fill(meeting.air, 0.6, {3, 0, 0});
  const Vec3 before = meeting.air.momentum();
  for (int i = 0; i < 60; ++i) meeting.step();
  EXPECT_EQ(meeting.coupling.body_count(), 1u);
  EXPECT_EQ(meeting.air.left(), 0u);
  const Vec3 gained = meeting.plant_momentum(), lost = before - meeting.air.momentum();
  EXPECT_GT(meeting.pressure.norm(), 0.02 * gained.norm()) << "pressure had a part in it";
  EXPECT_LT((gained - lost).norm(), 1e-3 * gained.norm());
}

TEST(PlantCoupling, DragOnAHeldBranchIsTheKnownOneAndTurnsWithTheWind) {
  for (const double speed : {3.0, -3.0}) {
    Meeting meeting(air_options(), loose(DomainKind::Branch, {0.004, 0.05, 0.004}, 700, {{0, 0, 0}}));
    fill(meeting.air, 0.6, {speed, 0, 0});
    meeting.step(false);
    const double area = kPi * 0.004 * 0.05;
    const double known = 0.5 * 1.2 * 1.1 * area * speed * std::abs(speed);
    // The air's coverage by a kernel of some 33 particles is known to some per cent.
    EXPECT_NEAR(meeting.drag.x() / kStep / known, 1, 0.08);
    EXPECT_LT(meeting.drag.tail<2>().norm(), 0.01 * meeting.drag.norm());
  }
}

TEST(PlantCoupling, ReachesFartherAlongABranchThanAcrossIt) {
  // Half a metre long: its kernel ends 0.7 m from its middle along it, 0.2 m across it (Eq. 13).
  for (const bool along : {true, false}) {
    Meeting meeting(air_options(), loose(DomainKind::Branch, {0.004, 0.5, 0.004}, 700, {{0, 0, 0}}));
    meeting.air.add(along ? Vec3(0, 0.6, 0) : Vec3(0.6, 0, 0), {0, 0, 1});
    meeting.air.sort();
    meeting.step(false);
    EXPECT_EQ(meeting.coupling.pairs(), along ? 1u : 0u);
  }
}

TEST(PlantCoupling, LeavesGrowingParticlesAlone) {
  Meeting meeting(air_options(), loose(DomainKind::Leaf, {0.03, 0.04, 2e-4}, 600, {{0, 0, 0}, {0.1, 0, 0}}));
  fill(meeting.air, 0.4, {3, 0, 0});
  meeting.growing = {0, 1};
  meeting.step();
  ASSERT_EQ(meeting.springs.size(), 1u);
  EXPECT_EQ(meeting.springs[0].particle, ParticleId(0));
}

TEST(PlantCoupling, DenseFoliageStopsTheAirAndDoesNotTurnItRound) {
  // Thousands of held leaves where the explicit reaction would exceed the air's momentum several times.
  Meeting meeting(air_options(), loose(DomainKind::Leaf, {0.05, 0.05, 2e-4}, 600, places(3000, 0.3)));
  for (Particle& p : meeting.plant.particles) p.mass *= 1e6, p.inertia *= 1e6;
  fill(meeting.air, 0.2, {0, 0, 4});
  for (int i = 0; i < 3; ++i) {
    meeting.step(false);
    for (size_t j = 0; j < meeting.air.size(); ++j)
      if (i == 0) {
        EXPECT_GT(meeting.air.velocity(j).z(), -0.06);
      }
  }
  EXPECT_LT(meeting.air.momentum().z(), 0.2 * 4 * meeting.air.particle_mass() * double(meeting.air.size()));
}

class EvenWind : public WindField {
 public:
  Vec3 velocity(const Vec3&, double) const override { return {0, 0, 2}; }
};

TEST(PlantCoupling, AddsTheAmbientWind) {
  const EvenWind ambient;
  const auto blade = [] { return loose(DomainKind::Branch, {0.004, 0.05, 0.004}, 700, {{0, 0, 0}}); };
  Meeting with(air_options(), blade()), without(air_options(), blade());
  fill(with.air, 0.6, {3, 0, 0});
  with.step(false, &ambient);
  without.step(false, &ambient);  // no particles: the ambient wind alone
  ASSERT_EQ(with.springs.size(), 1u);
  ASSERT_EQ(without.springs.size(), 1u);
  const auto force = [](const Meeting& m) -> Vec3 {
    return m.springs[0].damping * (m.springs[0].target_velocity - m.plant.motion[0].velocity);
  };
  const double unit = 0.5 * 1.2 * 1.1 * kPi * 0.004 * 0.05;
  EXPECT_LT((force(without) - unit * 2 * Vec3(0, 0, 2)).norm(), 1e-6 * unit);
  const Vec3 sum(3, 0, 2);  // seen full, but for the coverage
  EXPECT_LT((force(with) - unit * sum.norm() * sum).norm(), 0.1 * unit * sum.squaredNorm());
}

TEST(PlantCoupling, IsTheSameForOneAndTwoThreads) {
  uint64_t hash[2];
  for (unsigned threads : {1u, 2u}) {
    AirOptions options = air_options();
    options.threads = threads;
    PlacementOptions placement;
    placement.position = {0, -1, 0};
    Meeting meeting(options, make_plant(test::synthetic_bake({}), placement));
    fill(meeting.air, 0.6, {3, 0, 1});
    for (int i = 0; i < 10; ++i) meeting.step();
    hash[threads - 1] = state_hash(meeting.plant, hash_bytes(meeting.air.states(), 32 * meeting.air.size()));
  }
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace liana
