// [Haedrich17]'s scheme as published, and the ceiling of the frequencies that it can show.
#include <gtest/gtest.h>

#include "mesher/base/random.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/rotation.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/step/shape_matching.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

const StepOptions kWeightless{.gravity = Vec3::Zero()};

Plant clamped_chain(int particles, double dt, double youngs_modulus = 8.77e9) {
  Plant plant = test::rod_plant({.radius = 0.005, .youngs_modulus = youngs_modulus}, particles);
  plant.scheme = {.dt = dt, .solver = Solver::ShapeMatching};
  return plant;
}

// Hz, of the lowest swing: by the times at which the tip passes through its rest position.
double swing_frequency(Plant plant, int passes, int crossings) {
  const double dt = plant.scheme.dt;
  const auto n = static_cast<double>(plant.motion.size());
  for (size_t i = 1; i < plant.motion.size(); ++i)  // much like the lowest mode
    plant.motion[i].velocity.x() = 1e-3 * std::pow((static_cast<double>(i) + 0.5) / n, 2);
  ShapeMatchingStepper stepper({.passes = passes});
  StepOptions options = kWeightless;
  options.dt = dt;
  double before = 0, first = 0, last = 0;
  int seen = 0;
  // What the first swing still holds of faster modes makes the tip cross zero early: count from the second
  // on.
  for (int i = 1; seen <= crossings && i < 2'000'000; ++i) {
    stepper.step(plant, {}, {}, options);
    const double x = plant.motion.back().position.x();
    if (before * x < 0) {
      last = (i - x / (x - before)) * dt;
      if (seen++ == 0) first = last;
    }
    before = x;
  }
  return seen > crossings ? crossings / (2 * (last - first)) : 0;
}

// A chain of n particles clamped at its base, at s = 1: information travels one particle a pass, so the
// frequency falls with 1/n² and goes with √passes/Δt, a hundred times too low for a branch of 0.3 to 10 Hz at
// the paper's step.
TEST(ShapeMatching, FrequencyIsThatOfTheSolverNotOfTheBranch) {
  const struct {
    int particles;
    double hertz;  // at one pass and 25 ms, measured before with equal weights
  } rows[] = {{5, 0.19}, {10, 0.054}, {20, 0.015}};
  for (const auto& row : rows) {
    const double once = swing_frequency(clamped_chain(row.particles, 0.025), 1, 4);
    const double ten = swing_frequency(clamped_chain(row.particles, 0.025), 10, 4);
    const double fine = swing_frequency(clamped_chain(row.particles, 0.001), 10, 4);
    std::printf("%d particles: %.3f Hz; ten passes %.3f Hz; and 1 ms %.2f Hz\n", row.particles, once, ten,
                fine);
    // The weights are not the same, and tips that weigh half as much are shaken faster.
    EXPECT_NEAR(once, row.hertz, 0.25 * row.hertz) << row.particles;
    EXPECT_NEAR(ten / once, std::sqrt(10.0), 0.05 * std::sqrt(10.0)) << row.particles;
    EXPECT_NEAR(fine / ten, 25, 0.02 * 25) << row.particles;
  }
}

TEST(ShapeMatching, MaterialChangesNothing) {
  Plant soft = clamped_chain(10, 0.025, 1e6), stiff = clamped_chain(10, 0.025, 1e11);
  PlantStepper a, b;
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(a.step(soft, {}, {}, {}).calibrated);
    b.step(stiff, {}, {}, {});
  }
  EXPECT_GT(soft.motion.back().velocity.norm(), 1e-3);
  EXPECT_EQ(state_hash(soft), state_hash(stiff));
}

TEST(ShapeMatching, PlantAtRestStays) {
  Plant plant =
      make_plant(test::synthetic_bake({.branches = 3}), {.scheme = {.solver = Solver::ShapeMatching}});
  const MotionArray start = plant.motion;
  PlantStepper stepper;
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(stepper.step(plant, {}, {}, kWeightless).finite);
  for (size_t i = 0; i < start.size(); ++i) {
    EXPECT_LT((plant.motion[i].position - start[i].position).norm(), 1e-8);
    EXPECT_LT(plant.motion[i].orientation.angularDistance(start[i].orientation), 1e-7);
  }
}

// [Haedrich17] §4.3: s = 0.2 at first, 1 after ten seconds.
TEST(ShapeMatching, YoungParticleFollowsItsGoalByAFifth) {
  const auto moved_by = [](double youngest) {
    Plant whole = clamped_chain(3, 0.025), plant = whole;
    plant.particles.pop_back(), plant.motion.pop_back(), plant.branches[0].particles.pop_back();
    ShapeMatchingStepper stepper({.youngest = youngest});
    stepper.step(plant, {}, {}, kWeightless);
    plant.particles.push_back(whole.particles[2]);
    plant.motion.push_back(whole.motion[2]);
    plant.branches[0].particles.push_back(ParticleId(2));
    plant.motion[2].position.x() += 1e-3;
    stepper.step(plant, {}, {}, kWeightless);
    return 1e-3 - plant.motion[2].position.x();
  };
  const double full = moved_by(1), young = moved_by(0.2);
  EXPECT_GT(full, 1e-4);
  EXPECT_NEAR(young, (0.2 + 0.8 * 0.025 / 10) * full, 1e-9);
}

TEST(ShapeMatching, AnchorDrawsItsParticleByItsShare) {  // Eq. 5, and Eq. 1 without gravity
  Plant plant = clamped_chain(1, 0.025);
  plant.particles[0].joint.shear_stiffness.setZero();
  const double m = plant.particles[0].mass, k = 3 * m / (0.025 * 0.025);  // φ = 3/4
  const Vec3 start = plant.motion[0].position, target = start + Vec3(0.1, -0.2, 0.05);
  plant.anchors.push_back({.particle = ParticleId(0), .target = target, .stiffness = k * Mat3::Identity()});
  ShapeMatchingStepper stepper;
  stepper.step(plant, {}, {}, kWeightless);
  EXPECT_LT((plant.motion[0].position - (start + 0.75 * (target - start))).norm(), 1e-12);
}

TEST(ShapeMatching, StaysFiniteWhateverIsDone) {
  Plant plant =
      make_plant(test::synthetic_bake({.branches = 2}), {.scheme = {.solver = Solver::ShapeMatching}});
  Random random(1, "shape-matching/abuse");
  PlantStepper stepper;
  for (int i = 0; i < 400; ++i) {
    Motion& m = plant.motion[random.next() % plant.motion.size()];
    if (i < 200 && i % 5 == 0) m.velocity += Vec3(100, random.uniform(-50, 50), 50);
    ASSERT_TRUE(stepper.step(plant, {}, {}, {}).finite);
    for (const Motion& each : plant.motion) ASSERT_LT(each.velocity.norm(), 1000);
  }
}

TEST(PolarRotation, IsTheNearestRotation) {
  Random random(2, "shape-matching/polar");
  const auto any = [&] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  for (int i = 0; i < 1000; ++i) {
    // Thin groups have a moment of 1e-4 across; a fifth of the guesses is no guess at all.
    const Vec3 along(random.uniform(0.5, 1), random.uniform(1e-4, 0.5), random.uniform(1e-4, 1e-3));
    const Mat3 stretch = rotation_exp(any()).toRotationMatrix();
    const Mat3 R = rotation_exp(3 * any()).toRotationMatrix();
    const Mat3 A = R * stretch * along.asDiagonal() * stretch.transpose();
    const Quat guess = rotation_exp((i % 5 == 0 ? 3.0 : 0.1) * any()) * Quat(R);
    EXPECT_LT((polar_rotation(A, guess).toRotationMatrix() - R).norm(), 1e-9) << i;
  }
  const Quat guess = rotation_exp(Vec3(1, 2, 3));
  EXPECT_LT(polar_rotation(Mat3::Zero(), guess).angularDistance(guess), 1e-12);
}

}  // namespace
}  // namespace liana
