#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <complex>

#include "runtime/sim/calibrate/discrete_response.h"

namespace liana {
namespace {

using Complex = std::complex<double>;

Complex wanted_root(double frequency, double xi, double h) {
  const double omega = 2 * kPi * frequency;
  return std::exp(Complex(-xi * omega, omega * std::sqrt(1 - xi * xi)) * h);
}

TEST(DiscreteOscillator, MakesTheStepTurnAsWanted) {
  for (double rho : {0.0, 0.3, 0.6, 0.8, 1.0})
    for (double frequency : {0.1, 1.0, 3.0, 8.0})
      for (double xi : {0.05, 0.3, 0.6})
        for (double h : {0.025, 0.005}) {
          const UnitOscillator o = discrete_oscillator(frequency, xi, h, rho);
          if (!o.in_range) continue;
          const auto roots = amplification_matrix(o.stiffness, o.damping, h, rho).eigenvalues();
          const Complex z = wanted_root(frequency, xi, h);
          double nearest = 1;
          for (int i = 0; i < 3; ++i) {
            nearest = std::min(nearest, std::abs(roots[i] - z));
            EXPECT_LE(std::abs(roots[i]), 1 + 1e-9);
          }
          // A root moves by √ε where the two of a pair nearly meet (slow swings: z near 1).
          EXPECT_LT(nearest, 1e-7) << "rho " << rho << " nu " << frequency << " xi " << xi << " h " << h;
        }
}

TEST(DiscreteOscillator, IsTheMidpointRulesClosedFormAtRhoOne) {
  // λ' = (2/h)(z−1)/(z+1), k* = |λ'|², c* = −2 Re λ'.
  for (double frequency : {0.3, 2.0, 15.0})
    for (double xi : {0.0, 0.0065, 0.3}) {
      const double h = 0.025;
      const Complex z = wanted_root(frequency, xi, h), lambda = 2 / h * (z - 1.0) / (z + 1.0);
      const UnitOscillator o = discrete_oscillator(frequency, xi, h, 1);
      EXPECT_NEAR(o.stiffness, std::norm(lambda), 1e-9 * std::norm(lambda));
      EXPECT_NEAR(o.damping, std::max(0.0, -2 * lambda.real()), 1e-9 * std::abs(lambda));
    }
}

TEST(DiscreteOscillator, TendsToTheContinuousOneAsTheStepShrinks) {
  const double omega = 2 * kPi * 2, xi = 0.1;
  const UnitOscillator o = discrete_oscillator(2, xi, 1e-4, 0.6);
  EXPECT_NEAR(o.stiffness, omega * omega,
              1e-4 * omega * omega);  // second order: (ωh)² ≈ 1.6e-6, with a margin
  EXPECT_NEAR(o.damping, 2 * xi * omega, 1e-4 * 2 * xi * omega);
}

TEST(DiscreteOscillator, SaysWhereTheStepCannotFollow) {
  // At 25 ms and ξ = 0.0065 the step's own damping is the limit: about 2 Hz for ρ∞ = 0.3, 6 Hz for 0.6, 12 Hz
  // for 0.8.
  const auto in_range = [](double frequency, double rho) {
    return discrete_oscillator(frequency, 0.0065, 0.025, rho).in_range;
  };
  EXPECT_TRUE(in_range(1.5, 0.3));
  EXPECT_FALSE(in_range(3, 0.3));
  EXPECT_TRUE(in_range(5, 0.6));
  EXPECT_FALSE(in_range(8, 0.6));
  EXPECT_TRUE(in_range(10, 0.8));
  EXPECT_FALSE(in_range(15, 0.8));
  EXPECT_FALSE(discrete_oscillator(30, 0.3, 0.025, 1).in_range) << "beyond half the step rate";
}

}  // namespace
}  // namespace liana
