#include <gtest/gtest.h>

#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/check/frequency_probe.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

DampedSinusoid free_swing(const Plant& plant, BranchId branch) {
  HeldChain chain;
  chain.build(plant, branch, carried_masses(plant));
  chain.lowest_eigenvalue();
  return probe(chain).swing;
}

TEST(Calibration, ChainOfTwentySwingsAsWantedAtEveryStep) {
  for (double frequency : {0.3, 1.0, 2.0, 5.0})
    for (double xi : {0.0065, 0.05, 0.3})
      for (double dt : {0.025, 0.0125, 0.005}) {
        Plant plant = test::rod_plant({.frequency = frequency, .damping_factor = xi}, 20);
        const CalibrationReport report = calibrate_plant(plant, {.dt = dt});
        EXPECT_TRUE(report.note.empty()) << "the default scheme serves all of these";
        const DampedSinusoid swing = free_swing(plant, BranchId(0));
        EXPECT_NEAR(swing.frequency, frequency, 1e-3 * frequency) << frequency << ' ' << xi << ' ' << dt;
        EXPECT_NEAR(swing.damping_factor, xi, 1e-2 * xi) << frequency << ' ' << xi << ' ' << dt;
      }
}

TEST(Calibration, DoesNotDependOnTheNumberOfParticles) {
  for (int n : {1, 2, 5, 24}) {
    Plant plant = test::rod_plant({.frequency = 1.7, .damping_factor = 0.04}, n);
    calibrate_plant(plant);
    const DampedSinusoid swing = free_swing(plant, BranchId(0));
    EXPECT_NEAR(swing.frequency, 1.7, 1.7e-3) << n << " particles";
    EXPECT_NEAR(swing.damping_factor, 0.04, 4e-4) << n << " particles";
  }
}

TEST(Calibration, FlatLeafIsSoftAboutOneAxisAndStiffAboutTheOther) {
  for (int n : {1, 4}) {
    Plant plant = test::rod_plant({.length = 0.08, .radius = 0.012, .frequency = 4, .flatness = 5}, n);
    calibrate_plant(plant);
    EXPECT_NEAR(free_swing(plant, BranchId(0)).frequency, 4, 4e-3);
    const Joint& base = plant.particles[0].joint;
    EXPECT_NEAR(base.bend_stiffness.z(), 25 * base.bend_stiffness.x(), 1e-6 * base.bend_stiffness.z());
  }
}

TEST(Calibration, TakesTheSmallestChangeOfSchemeThatServesEveryBranchAndSaysSo) {
  Plant plant = test::rod_plant({.frequency = 9, .damping_factor = 0.0065}, 8);
  const CalibrationReport report = calibrate_plant(plant);
  EXPECT_EQ(report.scheme.substeps, 1);
  EXPECT_NEAR(plant.scheme.rho_infinity, 0.8, 0.101);
  EXPECT_EQ(report.beyond_wanted.size(), 1u);
  EXPECT_TRUE(report.out_of_range.empty());
  EXPECT_FALSE(report.note.empty());
  EXPECT_NEAR(free_swing(plant, BranchId(0)).frequency, 9, 9e-3);

  Plant fast = test::rod_plant({.frequency = 35, .damping_factor = 0.05}, 8);  // beyond half the step rate
  EXPECT_GT(calibrate_plant(fast).scheme.substeps, 1);
  EXPECT_NEAR(free_swing(fast, BranchId(0)).frequency, 35, 35e-3);
}

TEST(Calibration, UndampedBranchKeepsSwinging) {
  Plant plant = test::rod_plant({.frequency = 1, .damping_factor = 0}, 8);
  const CalibrationReport report = calibrate_plant(plant);
  EXPECT_TRUE(report.out_of_range.empty());
  EXPECT_NEAR(free_swing(plant, BranchId(0)).damping_factor, 0, 1e-4);
}

TEST(Calibration, ImpossibleTargetIsReportedAndLeavesAUsablePlant) {
  Plant plant = test::rod_plant({.frequency = 1e5, .damping_factor = 1.5}, 8);
  const CalibrationReport report = calibrate_plant(plant);
  EXPECT_EQ(report.out_of_range.size(), 1u);
  PlantStepper stepper;
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(stepper.step(plant, {}, {}, {}).finite);
}

TEST(Calibration, SecondTimeChangesNothing) {
  Plant plant = make_plant(test::synthetic_bake({.branches = 3}));
  const double before = plant.branches[2].stiffness_scale;
  calibrate_plant(plant);
  EXPECT_NEAR(plant.branches[2].stiffness_scale, before, 1e-8 * before);
}

TEST(Recalibration, DoesNotPop) {
  // A branch bent by its weight gets a stiffer target. What every joint exerts stays the same at that moment,
  // so the motion goes on as if nothing had happened: nothing moves faster than before.
  Plant plant = test::rod_plant({.frequency = 1, .damping_factor = 0.2}, 10);
  calibrate_plant(plant);
  PlantStepper stepper;
  const StepOptions sideways{.gravity = {2, 0, 0}};
  for (int i = 0; i < 1500; ++i) stepper.step(plant, {}, {}, sideways);
  const Vec3 bent = plant.motion.back().position;
  ASSERT_GT(bent.x(), 0.02);
  plant.branches[0].material.frequency = 2;
  HeldChain chain;
  ASSERT_TRUE(recalibrate(plant, BranchId(0), carried_masses(plant), chain));
  for (int i = 0; i < 200; ++i) stepper.step(plant, {}, {}, sideways);
  EXPECT_NEAR((plant.motion.back().position - bent).norm(), 0, 1e-6);
  EXPECT_NEAR(free_swing(plant, BranchId(0)).frequency, 2, 2e-3);
}

}  // namespace
}  // namespace liana
