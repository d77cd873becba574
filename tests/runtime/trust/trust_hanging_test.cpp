// Tension stiffens and compression softens: a branch that hangs or stands under gravity against beam elements
// with geometric stiffness.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/check/damped_sinusoid.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

/// Hz, lowest, of a clamped uniform beam of 1 m that swings at `frequency` without weight; gravity (m/s²)
/// pulls it away from its clamp. Euler-Bernoulli elements with the stiffness of the axial force.
double beam_frequency(double frequency, double gravity) {
  constexpr int kElements = 40, kSize = 2 * kElements;
  const double h = 1.0 / kElements, stiffness = std::pow(2 * kPi * frequency, 2) / 12.3623634;  // 1.8751⁴
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(kSize + 2, kSize + 2), m = k;
  for (int e = 0; e < kElements; ++e) {
    const double force = gravity * (1 - (e + 0.5) * h);
    Eigen::Matrix4d bend, axial, mass;
    bend << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h,  //
        -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h, -6 * h, 4 * h * h;
    axial << 36, 3 * h, -36, 3 * h, 3 * h, 4 * h * h, -3 * h, -h * h,  //
        -36, -3 * h, 36, -3 * h, 3 * h, -h * h, -3 * h, 4 * h * h;
    mass << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h,  //
        54, 13 * h, 156, -22 * h, -13 * h, -3 * h * h, -22 * h, 4 * h * h;
    k.block<4, 4>(2 * e, 2 * e) += stiffness / (h * h * h) * bend + force / (30 * h) * axial;
    m.block<4, 4>(2 * e, 2 * e) += h / 420 * mass;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      k.bottomRightCorner(kSize, kSize), m.bottomRightCorner(kSize, kSize), Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[0]) / (2 * kPi);
}

double particle_frequency(double frequency, double gravity) {
  Plant plant = test::rod_plant({.frequency = frequency, .damping_factor = 0.005}, 20);
  calibrate_plant(plant);
  for (Motion& m : plant.motion) m.velocity.x() = 1e-3 * m.position.y() * m.position.y();
  PlantStepper stepper;
  std::vector<double> record;
  for (int i = 0; i < 800; ++i) {
    EXPECT_EQ(stepper.step(plant, {}, {}, {.gravity = {0, gravity, 0}}).redone, 0);
    if (i >= 80) record.push_back(plant.motion.back().position.x());
  }
  return fit_damped_sinusoid(record, 0.025).frequency;
}

// The frequency is calibrated without gravity; the step warps the one with it by (ωh)²/12 of the difference,
// the chain of 20 has 0.1 % of its own.
TEST(Hanging, BranchSwingsFasterByItsTension) {
  for (const double frequency : {0.3, 0.7, 1.5, 4.0}) {
    const double wanted = beam_frequency(frequency, 9.81);
    EXPECT_GT(wanted, frequency);
    EXPECT_NEAR(particle_frequency(frequency, 9.81), wanted, 0.003 * wanted) << frequency;
  }
}

TEST(Standing, BranchSwingsSlowerByItsWeight) {
  for (const double frequency : {1.0, 2.0, 4.0}) {
    const double wanted = beam_frequency(frequency, -9.81);
    EXPECT_LT(wanted, frequency);
    EXPECT_NEAR(particle_frequency(frequency, -9.81), wanted, 0.003 * wanted) << frequency;
  }
}

}  // namespace
}  // namespace liana
