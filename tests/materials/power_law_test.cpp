#include "materials/law/power_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "materials/law/law_numbers.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

// Relative rounding of a few multiplications and one pow.
constexpr double kRounding = 1e-13;

// Eq. 8 by hand: C₁ = 2, ε₁ = −0.5, ℓ = 4: ν = 2 / √4 = 1.
TEST(FrequencyLaw, IsEquation8) {
  GroupLaw law{.reference_frequency = 2, .reference_length = 1, .epsilon1 = -0.5};
  EXPECT_NEAR(frequency_of_length(law, 4), 1.0, kRounding);
  EXPECT_NEAR(frequency_of_length(law, 0.25), 4.0, 4 * kRounding);
}

// ν_ref (ℓ/ℓ_ref)^ε₁ = C₁ ℓ^ε₁ with C₁ = ν_ref ℓ_ref^−ε₁.
TEST(FrequencyLaw, ReferenceFormEqualsC1Form) {
  const GroupLaw reference{.reference_frequency = 1.5, .reference_length = 2.5, .epsilon1 = -0.59};
  const GroupLaw c1{
      .reference_frequency = 1.5 * std::pow(2.5, 0.59), .reference_length = 1, .epsilon1 = -0.59};
  for (double length : {0.01, 0.3, 2.5, 20.0})
    EXPECT_NEAR(frequency_of_length(reference, length) / frequency_of_length(c1, length), 1, kRounding);
}

// §4.4: median materials, ν_med ℓ_med / ℓ, are the law with C₁ = ν_med ℓ_med and ε₁ = −1.
TEST(FrequencyLaw, MedianMaterialsAreASpecialCase) {
  const GroupLaw law{.reference_frequency = 1.2, .reference_length = 0.8, .epsilon1 = -1};
  EXPECT_NEAR(frequency_of_length(law, 0.8), 1.2, kRounding);
  EXPECT_NEAR(frequency_of_length(law, 0.4), 2.4, 3 * kRounding);
}

// Eq. 9 by hand: C₂ = 10, ε₂ = 1.5, ℓ = 4: α_m = 10 · 8 = 80.
TEST(MassScaling, IsEquation9) {
  const GroupLaw law{.c2 = 10, .epsilon2 = 1.5};
  EXPECT_NEAR(mass_scaling_of_length(law, 4), 80, 80 * kRounding);
  EXPECT_NEAR(mass_scaling_of_length(law, 1), 10, 10 * kRounding);
}

// Eq. 10 by hand: α_m = 3, ν = 2, ν_default = 8: α_k = 3 (2/8)² = 0.1875, and Eq. 3's ν_default √(α_k/α_m) is
// ν.
TEST(StiffnessScaling, IsEquation10AndGivesBackTheFrequencyOfEquation3) {
  const double alpha_k = stiffness_scaling(3, 2, 8);
  EXPECT_NEAR(alpha_k, 0.1875, kRounding);
  EXPECT_NEAR(8 * std::sqrt(alpha_k / 3), 2, 2 * kRounding);
}

// Eq. 11 by hand: ε₃ = 2, s_max = 1, s_min = 0.2, half way: t = 0.25, s = 0.75 · 0.2 + 0.25 = 0.4.
TEST(TaperScaling, IsEquation11) {
  const TaperLaw law{.root_scaling = 1, .tip_scaling = 0.2, .epsilon3 = 2};
  EXPECT_NEAR(taper_scaling(law, 0.5), 0.4, kRounding);
  EXPECT_EQ(taper_scaling(law, 0), 1.0);
  EXPECT_EQ(taper_scaling(law, 1), 0.2);
}

TEST(Evaluate, GivesAllFourLawsAtOnce) {
  const GroupLaw law{.reference_frequency = 2,
                     .reference_length = 1,
                     .epsilon1 = -0.5,
                     .c2 = 3,
                     .epsilon2 = 0.5,
                     .damping = {.low_frequency = 0.5,
                                 .high_frequency = 1.5,
                                 .low_factor = 0.1,
                                 .high_factor = 0.3,
                                 .kappa = 2,
                                 .delta = 1}};
  const DomainMaterial material = evaluate(law, 4);  // ν = 1, half way between the two damping frequencies
  EXPECT_NEAR(material.frequency, 1, kRounding);
  EXPECT_NEAR(material.mass_scaling, 6, 6 * kRounding);
  EXPECT_NEAR(material.damping_factor, 0.2, kRounding);
  EXPECT_NEAR(material.mass_damping, 4 * kPi * (4 - 2) / 3. * 0.2, 10 * kRounding);
  EXPECT_NEAR(material.stiffness_damping, 1 / kPi * (2 - 1) / 3. * 0.2, kRounding);
}

TEST(Evaluate, RefusesALengthThatIsNotOne) {
  for (double length :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(evaluate(GroupLaw{}, length), Error) << length;
}

TEST(Evaluate, RefusesNumbersOutOfRange) {
  const auto broken = [](auto change) {
    GroupLaw law;
    change(law);
    EXPECT_THROW(evaluate(law, 1), Error);
  };
  broken([](GroupLaw& law) { law.reference_frequency = -1; });
  broken([](GroupLaw& law) { law.reference_length = 0; });
  broken([](GroupLaw& law) { law.epsilon1 = std::nan(""); });
  broken([](GroupLaw& law) { law.c2 = 0; });
  broken([](GroupLaw& law) { law.damping.low_factor = -0.1; });
  broken([](GroupLaw& law) { law.damping.high_factor = 5.1; });
  broken([](GroupLaw& law) { law.damping.kappa = 1; });
  broken([](GroupLaw& law) { law.damping.delta = 2.1; });
  broken([](GroupLaw& law) { law.damping.delta = 0.49; });
  broken([](GroupLaw& law) { law.damping.low_frequency = 4; });
  EXPECT_NO_THROW(evaluate(GroupLaw{}, 1));
}

TEST(SpeciesLaw, UnnamedLevelTakesTheDeepestLevelAboveIt) {
  SpeciesLaw law{.species = "test"};
  law.groups["level0"].c2 = 10;
  law.groups["level2"].c2 = 12;
  law.groups["leaf"].c2 = 99;
  EXPECT_EQ(law.group("level0").c2, 10);
  EXPECT_EQ(law.group("level1").c2, 10);
  EXPECT_EQ(law.group("level2").c2, 12);
  EXPECT_EQ(law.group("level7").c2, 12);
  EXPECT_EQ(law.group("leaf").c2, 99);
}

TEST(SpeciesLaw, UnknownGroupIsNamedWithTheKnownOnes) {
  SpeciesLaw law{.species = "test"};
  law.groups["leaf"] = {};
  for (const char* name : {"fruit", "level0", "level", "levelx", "level-1", "level99999999999"}) {
    try {
      law.group(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      EXPECT_NE(error.hint.find("leaf"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace liana
