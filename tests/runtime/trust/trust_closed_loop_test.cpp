// The closed loop to its goal bars: frequency to 0.2 %, damping to 2 % or 0.0005, from 0.3 to 10 Hz.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/check/frequency_probe.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

struct FreeSwing {
  DampedSinusoid swing;
  bool served;
};

FreeSwing free_swing(double frequency, double damping_factor, int particles, double dt) {
  Plant plant = test::rod_plant({.frequency = frequency, .damping_factor = damping_factor}, particles);
  const bool served = calibrate_plant(plant, {.dt = dt}).out_of_range.empty();
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  chain.lowest_eigenvalue();
  return {probe(chain).swing, served};
}

TEST(ClosedLoop, MeetsItsBarsFromThreeTenthsToTenHertzAtThePapersStep) {
  double worst_frequency = 0, worst_damping = 0;
  for (const double frequency : {0.3, 0.7, 1.5, 3.0, 6.0, 10.0})
    for (const double xi : {0.005, 0.02, 0.1, 0.3, 0.6}) {
      const FreeSwing p = free_swing(frequency, xi, 12, 0.025);
      ASSERT_TRUE(p.served && p.swing.found) << frequency << ' ' << xi;
      const double off = std::abs(p.swing.frequency / frequency - 1);
      const double damping_off = std::abs(p.swing.damping_factor - xi), bar = std::max(0.0005, 0.02 * xi);
      EXPECT_LT(off, 0.002) << "nu " << frequency << " xi " << xi;
      EXPECT_LT(damping_off, bar) << "nu " << frequency << " xi " << xi;
      worst_frequency = std::max(worst_frequency, off);
      worst_damping = std::max(worst_damping, damping_off / bar);
    }
  RecordProperty("worst_frequency", std::to_string(worst_frequency));
  RecordProperty("worst_damping_of_its_bar", std::to_string(worst_damping));
}

TEST(ClosedLoop, DoesNotDependOnStepNorOnNumberOfParticles) {
  double worst = 0, worst_damping = 0;
  for (const double frequency : {0.3, 2.0, 8.0})
    for (const double xi : {0.01, 0.2}) {
      double low = 1e9, high = 0, least = 1e9, most = 0;
      for (const double dt : {0.025, 0.0125, 0.005})
        for (const int particles : {10, 30, 100}) {
          const FreeSwing p = free_swing(frequency, xi, particles, dt);
          low = std::min(low, p.swing.frequency);
          high = std::max(high, p.swing.frequency);
          least = std::min(least, p.swing.damping_factor);
          most = std::max(most, p.swing.damping_factor);
        }
      EXPECT_LT(high - low, 0.003 * frequency) << "nu " << frequency << " xi " << xi;
      EXPECT_LT(most - least, std::max(0.0005, 0.003 * xi)) << "nu " << frequency << " xi " << xi;
      worst = std::max(worst, (high - low) / frequency);
      worst_damping = std::max(worst_damping, most - least);
    }
  RecordProperty("worst_spread_of_frequency", std::to_string(worst));
  RecordProperty("worst_spread_of_damping", std::to_string(worst_damping));
}

// What the step adds of its own shows over a minute: the swing's size at its start and at its end.
TEST(ClosedLoop, UndampedBranchKeepsItsSwingForAMinute) {
  double worst = 0;
  for (const double frequency : {0.3, 1.0, 3.0, 10.0})
    for (const double amplitude : {1e-4, 1e-2}) {  // m, of 1 m: linear, and not quite
      Plant plant = test::rod_plant({.frequency = frequency, .damping_factor = 0}, 12);
      ASSERT_TRUE(calibrate_plant(plant).out_of_range.empty());
      HeldChain chain;
      chain.build(plant, BranchId(0), carried_masses(plant));
      chain.lowest_eigenvalue();
      const double scale = amplitude / chain.mode().back().head<3>().norm();
      const Vec3 direction = chain.mode().back().head<3>().normalized();
      for (size_t i = 0; i < plant.motion.size(); ++i) {
        plant.motion[i].position += scale * chain.mode()[i].head<3>();
        plant.motion[i].orientation =
            rotation_exp(scale * chain.mode()[i].tail<3>()) * plant.motion[i].orientation;
      }
      PlantStepper stepper;
      std::vector<double> record;
      int redone = 0;
      for (int i = 0; i < 2400; ++i) {
        redone += stepper.step(plant, {}, {}, {.gravity = Vec3::Zero()}).redone;
        record.push_back(direction.dot(plant.motion.back().position));
      }
      // Root mean square over ten seconds, a whole number of swings: from the 2nd to the 12th, and the last
      // ten.
      const auto size = [&](size_t from) {
        double sum = 0;
        for (size_t i = from; i < from + 400; ++i) sum += record[i] * record[i];
        return std::sqrt(sum);
      };
      const double xi = std::log(size(80) / size(2000)) / (2 * kPi * frequency * 0.025 * (2000 - 80));
      EXPECT_LT(std::abs(xi), 2e-4) << "nu " << frequency << " amplitude " << amplitude;
      EXPECT_EQ(redone, 0);
      worst = std::max(worst, std::abs(xi));
    }
  RecordProperty("worst_drift", std::to_string(worst));
}

}  // namespace
}  // namespace liana
