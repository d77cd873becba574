// The lanes against the plain step, against each other, and the order they are filled in.
#include <gtest/gtest.h>

#include <set>

#include "runtime/sim/elimination_order.h"
#include "runtime/sim/plant_from_bake.h"
#include "runtime/sim/state_hash.h"
#include "runtime/sim/time_step.h"
#include "tests/support/reference_step.h"
#include "tests/support/synthetic_bake.h"

namespace liana {
namespace {

// A tree in violent motion, anchored here and there, in wind: nothing is zero, no symmetry helps.
struct Storm {
  Plant plant;
  std::vector<Wrench> wind;
  std::vector<WorldSpring> springs;

  explicit Storm(int branches, double speed) : plant(make_plant(test::synthetic_bake({.branches = branches}))) {
    uint32_t state = 1;
    const auto random = [&] { return static_cast<double>((state = state * 1664525u + 1013904223u) >> 8) / 8388608 - 1; };
    const auto vector = [&] { return Vec3(random(), random(), random()); };
    for (Motion& m : plant.motion) {
      m.velocity = speed * vector();
      m.angular_velocity = 10 * speed * vector();
      m.acceleration = 40 * speed * vector();
      m.angular_acceleration = 100 * speed * vector();
      wind.push_back({1e-3 * vector(), 1e-5 * vector()});
    }
    for (size_t i = 3; i < plant.particles.size(); i += 17) {
      const Mat3 L = Vec3(1, 2, 3).asDiagonal() * Quat(Eigen::AngleAxisd(random(), Vec3::UnitX())).matrix();
      const WorldSpring spring{ParticleId(i), 0.01 * vector(), plant.motion[i].position + 0.01 * vector(),
                               20 * L * L.transpose(), L * L.transpose(), vector()};
      (i % 2 ? plant.anchors : springs).push_back(spring);
    }
  }
};

TEST(Lanes, TakeTheSameStepAsThePlainSolver) {
  for (const double speed : {0.01, 1.0}) {
    Storm a(6, speed), b(6, speed);
    PlantStepper lanes;
    test::ReferenceStepper plain;
    for (int i = 0; i < 5; ++i) {
      const StepOptions options{.most_redo_substeps = 1};
      const StepReport report = lanes.step(a.plant, a.wind, a.springs, options);
      ASSERT_TRUE(plain.step(b.plant, b.wind, b.springs, options));
      double velocity = 0, spin = 0, difference = 0, turning = 0;
      for (size_t k = 0; k < a.plant.motion.size(); ++k) {
        const Motion &x = a.plant.motion[k], &y = b.plant.motion[k];
        velocity = std::max(velocity, y.velocity.norm());
        spin = std::max(spin, y.angular_velocity.norm());
        difference = std::max(difference, (x.velocity - y.velocity).norm());
        turning = std::max(turning, (x.angular_velocity - y.angular_velocity).norm());
      }
      // Joints are up to 1e6 times stiffer than what hangs on them: 1e-16 of a stretched joint's force counts so much more.
      EXPECT_LT(difference, 1e-8 * velocity) << "step " << i << " at speed " << speed;
      EXPECT_LT(turning, 1e-8 * spin);
      EXPECT_NEAR(report.gap, plain.gap(), 1e-8 * plain.gap());
    }
  }
}

TEST(Lanes, GiveTheSameBitsOnEveryProcessor) {
  if (!lanes::avx2_kernels()) GTEST_SKIP() << "this processor has no AVX2";
  for (const double speed : {0.1, 30.0}) {  // the faster one is redone, and turns by more than half a circle a step
    uint64_t hash[2];
    for (int k = 0; k < 2; ++k) {
      Storm storm(5, speed);
      PlantStepper stepper;
      stepper.use(k == 0 ? lanes::portable_kernels() : *lanes::avx2_kernels());
      for (int i = 0; i < 40; ++i) stepper.step(storm.plant, storm.wind, storm.springs, {});
      hash[k] = state_hash(storm.plant);
    }
    EXPECT_EQ(hash[0], hash[1]);
  }
}

TEST(EliminationOrder, PutsChildrenBeforeParentsAndEveryParticleOnce) {
  const Plant plant = make_plant(test::synthetic_bake({.branches = 9}));
  EliminationOrder order;
  ASSERT_TRUE(order.update(plant.particles));
  EXPECT_FALSE(order.update(plant.particles)) << "nothing changed";
  std::set<uint32_t> done;
  for (const lanes::Pack& pack : order.packs()) {
    for (uint32_t k = 0; k < pack.count; ++k) {
      const uint32_t i = pack.self[k];
      const ParticleId parent = plant.particles[i].parent;
      EXPECT_EQ(pack.parent[k], parent.valid() ? parent.value : plant.particles.size());
      EXPECT_FALSE(parent.valid() && done.count(parent.value));
      for (uint32_t other = 0; other < pack.count; ++other) EXPECT_NE(pack.parent[k], pack.self[other]);
    }
    for (uint32_t k = 0; k < pack.count; ++k) EXPECT_TRUE(done.insert(pack.self[k]).second);
  }
  EXPECT_EQ(done.size(), plant.particles.size());
  // A twelfth of the lanes at most stay empty: the trunk's last few particles have nobody beside them.
  EXPECT_LT(order.packs().size(), plant.particles.size() / 4 * 13 / 12);
}

}  // namespace
}  // namespace liana
