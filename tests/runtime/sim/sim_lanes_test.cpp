// The lanes against the plain step, against each other, and the order they are filled in.
#include <gtest/gtest.h>

#include <set>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/step/elimination_order.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/reference_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

// A tree in violent motion, anchored here and there, in wind: nothing is zero, no symmetry helps.
struct Storm {
  Plant plant;
  std::vector<Wrench> wind;
  std::vector<WorldSpring> springs;

  explicit Storm(int branches, double speed)
      : plant(make_plant(test::synthetic_bake({.branches = branches}))) {
    uint32_t state = 1;
    const auto random = [&] {
      return static_cast<double>((state = state * 1664525u + 1013904223u) >> 8) / 8388608 - 1;
    };
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
      const WorldSpring spring{
          ParticleId(i),          0.01 * vector(),   plant.motion[i].position + 0.01 * vector(),
          20 * L * L.transpose(), L * L.transpose(), vector()};
      (i % 2 ? plant.anchors : springs).push_back(spring);
    }
  }
};

TEST(Lanes, TakeTheSameStepAsThePlainSolver) {
  for (const double speed : {0.01, 1.0}) {
    const int branches = speed < 1 ? 4 : 30;  // one part, and many
    Storm a(branches, speed), b(branches, speed);
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
      // Joints are up to 1e6 times stiffer than what hangs on them: 1e-16 of a stretched joint's force counts
      // so much more.
      EXPECT_LT(difference, 1e-8 * velocity) << "step " << i << " at speed " << speed;
      EXPECT_LT(turning, 1e-8 * spin);
      EXPECT_NEAR(report.gap, plain.gap(), 1e-8 * plain.gap());
    }
  }
}

TEST(Lanes, AStepTakenAgainWithMoreSpringsIsThatStep) {
  for (const unsigned threads : {1u, 2u}) {
    Storm storm(30, 0.2), other(30, 0.3);
    PlantStepper stepper, elsewhere;
    StepWorkspace shared, another;
    const StepOptions options{.most_redo_substeps = 1, .threads = threads};
    for (int i = 0; i < 12; ++i) {
      const MotionArray start = storm.plant.motion;
      std::vector<WorldSpring> springs = storm.springs;
      stepper.step(storm.plant, storm.wind, springs, options, shared);
      // Another plant in between takes the workspace; or this one goes on in another.
      if (i % 3 == 2) elsewhere.step(other.plant, other.wind, other.springs, options, shared);
      StepWorkspace& workspace = i % 4 == 3 ? another : shared;
      std::vector<uint64_t> hashes;
      std::vector<double> gaps;
      size_t known = springs.size();
      for (int pass = 0; pass < 2; ++pass) {
        known = springs.size();
        const size_t at = (977 * static_cast<size_t>(i + 5 * pass) + 13) % storm.plant.particles.size();
        springs.push_back(
            {ParticleId(at), Vec3::Zero(), start[at].position, 300 * Mat3::Identity(), Mat3::Identity()});
        storm.plant.motion = start;
        gaps.push_back(stepper.again(storm.plant, storm.wind, springs, known, options, workspace).gap);
        hashes.push_back(state_hash(storm.plant));
      }
      for (size_t pass = 0; pass < 2; ++pass) {
        Plant whole = storm.plant;
        whole.motion = start;
        const std::span<const WorldSpring> those(springs.data(), known + pass);
        ASSERT_EQ(PlantStepper().step(whole, storm.wind, those, options).gap, gaps[pass]);
        ASSERT_EQ(state_hash(whole), hashes[pass]) << "step " << i << ", pass " << pass;
      }
    }
  }
}

TEST(Lanes, GiveTheSameBitsOnEveryProcessor) {
  std::vector<const lanes::Kernels*> copies{&lanes::portable_kernels()};
  for (const lanes::Kernels* copy : {lanes::avx2_kernels(), lanes::avx512_kernels()})
    if (copy) copies.push_back(copy);
  if (copies.size() == 1) GTEST_SKIP() << "this processor has neither AVX2 nor AVX-512";
  for (const double speed :
       {0.1, 30.0}) {  // the faster one is redone, and turns by more than half a circle a step
    std::set<uint64_t> hashes;
    for (const lanes::Kernels* copy : copies) {
      Storm storm(5, speed);
      PlantStepper stepper;
      stepper.use(*copy);
      for (int i = 0; i < 40; ++i) stepper.step(storm.plant, storm.wind, storm.springs, {});
      hashes.insert(state_hash(storm.plant));
    }
    EXPECT_EQ(hashes.size(), 1u);
  }
}

TEST(Lanes, GiveTheSameBitsOnAnyNumberOfThreads) {
  for (const double speed : {0.1, 30.0}) {
    std::set<uint64_t> hashes;
    for (const unsigned threads : {1u, 2u, 5u, 99u}) {  // the last is more than there are parts
      Storm storm(20, speed);
      PlantStepper stepper;
      for (int i = 0; i < 8; ++i) {
        // Another tree halfway, of as many particles: all threads must see it.
        if (i == 4) storm.plant.particles.back().parent = ParticleId(1);
        stepper.step(storm.plant, storm.wind, storm.springs, {.threads = threads});
      }
      hashes.insert(state_hash(storm.plant));
    }
    EXPECT_EQ(hashes.size(), 1u) << "at speed " << speed;
  }
}

void expect_sound(const EliminationOrder& order, const Plant& plant, double fill) {
  const auto packs = order.packs();
  std::set<uint32_t> done;
  std::vector<EliminationOrder::Supernode> parts(order.supernodes().begin(), order.supernodes().end());
  parts.push_back(order.top());
  for (const auto& [first, last, extend_add] : parts) {
    std::set<uint32_t> slots;
    for (uint32_t p = first; p < last; ++p) {
      const lanes::Pack& pack = packs[p];
      for (uint32_t k = 0; k < pack.count; ++k) {
        const ParticleId self(pack.self[k]), parent = plant.particles[pack.self[k]].parent;
        EXPECT_TRUE(slots.insert(pack.slot[k]).second) << "two particles of a part in one place";
        EXPECT_EQ(pack.slot[k], order.slot_of(self));
        EXPECT_EQ(pack.parent[k], parent.valid() ? order.slot_of(parent) : order.world_slot());
        EXPECT_FALSE(parent.valid() && done.count(parent.value)) << "a parent before its child";
        for (uint32_t other = 0; other < pack.count; ++other) EXPECT_NE(parent.value, pack.self[other]);
      }
      for (uint32_t k = 0; k < pack.count; ++k) EXPECT_TRUE(done.insert(pack.self[k]).second);
    }
  }
  EXPECT_EQ(done.size(), plant.particles.size());
  EXPECT_LT(static_cast<double>(packs.size()), static_cast<double>(plant.particles.size()) / 4 / fill);
}

TEST(EliminationOrder, PutsChildrenBeforeParentsAndEveryParticleOnce) {
  for (const int branches : {1, 2, 40}) {
    const Plant plant = make_plant(test::synthetic_bake({.branches = branches}));
    EliminationOrder order;
    order.update(plant.particles, false);
    // Few lanes stay empty; in a small plant the trunk's particles have nobody beside them.
    expect_sound(order, plant, branches == 40 ? 0.9 : 0.5);
    EXPECT_EQ(order.supernodes().empty(), branches < 40);
  }
}

TEST(EliminationOrder, NoticesAnotherTreeOfTheSameSize) {
  Plant plant = make_plant(test::synthetic_bake({.branches = 40}));
  EliminationOrder order;
  order.update(plant.particles, false);
  const auto holds = [&] {
    bool all = order.still_holds(plant.particles, order.top());
    for (const auto& part : order.supernodes()) all &= order.still_holds(plant.particles, part);
    return all;
  };
  EXPECT_TRUE(holds());
  plant.particles.back().parent = ParticleId(0);
  EXPECT_FALSE(holds());
  order.update(plant.particles, true);
  EXPECT_TRUE(holds());
  expect_sound(order, plant, 0.9);
}

}  // namespace
}  // namespace liana
