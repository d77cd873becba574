#include "materials/law/damping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/law/law_numbers.h"

namespace liana {
namespace {

constexpr double kRounding = 1e-13;

DampingLaw with(double kappa, double delta) {
  DampingLaw law;
  law.kappa = kappa;
  law.delta = delta;
  return law;
}

// Eq. 12 by hand: d_M = 4π, d_K = 0, ν = 2: ξ = ½ · 4π/(4π) = ½. d_M = 0, d_K = 1/(10π), ν = 1: ξ = ½ ·
// 2π/(10π) = 0.1.
TEST(ModalDampingFactor, IsEquation12) {
  EXPECT_NEAR(modal_damping_factor({.mass = 4 * kPi, .stiffness = 0}, 2), 0.5, kRounding);
  EXPECT_NEAR(modal_damping_factor({.mass = 0, .stiffness = 1 / (10 * kPi)}, 1), 0.1, kRounding);
}

// Eq. 13 with the palm of Table 1: (1 Hz, 3 Hz, 0.0065, 0.1); half way between, (0.0065 + 0.1) / 2 = 0.05325.
TEST(DampingFactor, IsEquation13WithFactorsAsConstantPieces) {
  const DampingLaw palm{.low_frequency = 1, .high_frequency = 3, .low_factor = 0.0065, .high_factor = 0.1};
  EXPECT_EQ(damping_factor(palm, 0.2), 0.0065);
  EXPECT_EQ(damping_factor(palm, 1), 0.0065);
  EXPECT_NEAR(damping_factor(palm, 2), 0.05325, kRounding);
  EXPECT_EQ(damping_factor(palm, 3), 0.1);
  EXPECT_EQ(damping_factor(palm, 30), 0.1);
}

TEST(DampingFactor, StepsWhereTheTwoFrequenciesMeet) {
  const DampingLaw law{.low_frequency = 2, .high_frequency = 2, .low_factor = 0.1, .high_factor = 0.3};
  EXPECT_EQ(damping_factor(law, 2), 0.1);
  EXPECT_EQ(damping_factor(law, 2.001), 0.3);
}

// Eq. 15 by hand with the schefflera of Table 1, κ = 5, δ = 0.25, at ν = 1, ξ = 0.04:
// d_M = 4π (25 − 1.25)/24 · 0.04 = 0.158333 π, d_K = (1/π)(1.25 − 1)/24 · 0.04 = 4.16667e-4/π.
TEST(RayleighDamping, IsEquation15) {
  const RayleighDamping damping = rayleigh_damping(with(5, 0.25), 1, 0.04);
  EXPECT_NEAR(damping.mass, 0.158333333333333 * kPi, 1e-14);
  EXPECT_NEAR(damping.stiffness, 4.16666666666667e-4 / kPi, 1e-16);
}

// "Our default settings are δ = κ = 2, which sets d_M to 0": d_K = (1/π)(4 − 1)/(3 ν) ξ = ξ/(π ν).
TEST(RayleighDamping, DefaultsHaveNoMassDamping) {
  const RayleighDamping damping = rayleigh_damping(DampingLaw{}, 1.6, 0.05);
  EXPECT_EQ(damping.mass, 0);
  EXPECT_NEAR(damping.stiffness, 0.05 / (kPi * 1.6), kRounding);
}

// Eq. 15 solves Eq. 12 and Eq. 14 at once, and is never negative for δ in [1/κ, κ].
TEST(RayleighDamping, SolvesEquations12And14) {
  for (double kappa : {1.1, 2.0, 5.0})
    for (double t : {0.0, 0.3, 0.7, 1.0}) {
      const DampingLaw law = with(kappa, 1 / kappa + t * (kappa - 1 / kappa));
      const RayleighDamping damping = rayleigh_damping(law, 0.7, 0.08);
      EXPECT_NEAR(modal_damping_factor(damping, 0.7), 0.08, kRounding);
      EXPECT_NEAR(modal_damping_factor(damping, kappa * 0.7), law.delta * 0.08, kRounding);
      EXPECT_GE(damping.mass, -kRounding);
      EXPECT_GE(damping.stiffness, -kRounding);
    }
}

// Eq. 16 by hand: κ = 2, δ = 1: ν* = ν √((4 − 2)/(2 − 1)) = √2 ν; and it is √(d_M/d_K)/2π.
TEST(LeastDampedFrequency, IsEquation16) {
  EXPECT_NEAR(least_damped_frequency(with(2, 1), 3), 3 * std::sqrt(2.), 10 * kRounding);
  const RayleighDamping damping = rayleigh_damping(with(2, 1), 3, 0.1);
  EXPECT_NEAR(std::sqrt(damping.mass / damping.stiffness) / (2 * kPi), 3 * std::sqrt(2.), 10 * kRounding);
  EXPECT_EQ(least_damped_frequency(with(2, 2), 3), 0);
  EXPECT_TRUE(std::isinf(least_damped_frequency(with(2, 0.5), 3)));
}

TEST(LeastDampedFrequency, IsTheMinimumOfEquation12) {
  const RayleighDamping damping = rayleigh_damping(with(2, 1), 3, 0.1);
  const double least = least_damped_frequency(with(2, 1), 3);
  EXPECT_LT(modal_damping_factor(damping, least), modal_damping_factor(damping, 0.99 * least));
  EXPECT_LT(modal_damping_factor(damping, least), modal_damping_factor(damping, 1.01 * least));
}

// κ = 2: δ in [1/2, 4/5] or [5/4, 2].
TEST(Monotonicity, HoldsExactlyOutsideTheGapAroundOne) {
  for (double delta : {0.5, 0.79, 0.8, 1.25, 1.26, 2.0}) EXPECT_TRUE(is_monotonic(with(2, delta))) << delta;
  for (double delta : {0.49, 0.81, 1.0, 1.24, 2.01}) EXPECT_FALSE(is_monotonic(with(2, delta))) << delta;
}

// The interval is where ν* lies outside (ν, κν).
TEST(Monotonicity, AgreesWithWhereTheMinimumLies) {
  for (double kappa : {1.5, 2.0, 5.0})
    for (int i = 1; i < 197; ++i) {  // 197 is prime: no delta falls on a bound
      const DampingLaw law = with(kappa, 1 / kappa + i / 197. * (kappa - 1 / kappa));
      const double least = least_damped_frequency(law, 1);
      EXPECT_EQ(is_monotonic(law), least <= 1 || least >= kappa) << kappa << " " << law.delta;
    }
}

TEST(DampingProblem, IsNamedOnlyOutsideTheBounds) {
  EXPECT_EQ(damping_problem(with(5, 0.2)), "");
  EXPECT_EQ(damping_problem(with(3, 0.3333333333333333)), "");
  EXPECT_EQ(damping_problem(with(5, 5)), "");
  EXPECT_NE(damping_problem(with(5, 0.19)).find("[1/kappa, kappa]"), std::string::npos);
  EXPECT_NE(damping_problem(with(5, 5.01)), "");
}

}  // namespace
}  // namespace liana
