#include "materials/law/material_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/law/power_law.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

SpeciesLaw law() {
  SpeciesLaw law;
  law.species = "test";
  law.groups["level0"].reference_frequency = 1.5;
  law.groups["level1"].reference_frequency = 2;
  law.groups["leaf"].reference_frequency = 4;
  return law;
}

/// The second is the longest branch of the lowest level, hence the main trunk.
const std::vector<ModelledDomain> kDomains = {
    {"level0", DomainKind::Branch, 0, 1.0, 3.0}, {"level0", DomainKind::Branch, 0, 4.0, 0.8},
    {"level1", DomainKind::Branch, 1, 0.5, 9.0}, {"level1", DomainKind::Branch, 1, 0.7, 7.0},
    {"level1", DomainKind::Branch, 1, 1.5, 6.0}, {"leaf", DomainKind::Leaf, 1, 0.1, 2.0},
    {"leaf", DomainKind::Leaf, 2, 0.2, 1.0}};

std::vector<double> by(MaterialModel model, SpeciesLaw law = liana::law()) {
  law.model.model = model;
  return model_frequencies(law, kDomains).frequencies;
}

TEST(MaterialModel, PowerLawIsEquation8) {
  const std::vector<double> frequencies = by(MaterialModel::PowerLaw);
  for (size_t i = 0; i < kDomains.size(); ++i)
    EXPECT_EQ(frequencies[i], evaluate(law().group(kDomains[i].group), kDomains[i].length).frequency);
}

// One factor on Young's modulus: all frequencies in the proportion that the shapes give them.
TEST(MaterialModel, ConstantKeepsTheProportionsOfTheDefaultMaterial) {
  SpeciesLaw one = law();
  one.model.trunk_frequency = 1;
  const std::vector<double> frequencies = by(MaterialModel::Constant, one);
  EXPECT_DOUBLE_EQ(frequencies[1], 1);
  for (size_t i = 0; i < kDomains.size(); ++i)
    EXPECT_DOUBLE_EQ(frequencies[i] / kDomains[i].default_frequency, 1 / 0.8);
  EXPECT_DOUBLE_EQ(by(MaterialModel::Constant)[1], frequency_of_length(law().group("level0"), 4));
}

TEST(MaterialModel, DepthScalesStiffnessByLevel) {
  SpeciesLaw given = law();
  given.model.depth_scale = 400, given.model.depth_discount = 0.25;
  const std::vector<double> frequencies = by(MaterialModel::Depth, given);
  for (size_t i = 0; i < kDomains.size(); ++i)  // ν_default √(400 / 4^level) = 20 ν_default / 2^level
    EXPECT_DOUBLE_EQ(frequencies[i], 20 * kDomains[i].default_frequency / std::pow(2, kDomains[i].level));
  EXPECT_DOUBLE_EQ(by(MaterialModel::Depth)[1], frequency_of_length(law().group("level0"), 4));
}

// [Wang17] §4.4: the special case C₁ = ν_med ℓ_med, ε₁ = -1 of the power law.
TEST(MaterialModel, MedianIsAPowerLawThroughTheMedianLength) {
  SpeciesLaw given = law();
  given.groups["level1"].median_frequency = 3;
  const std::vector<double> frequencies = by(MaterialModel::Median, given);
  EXPECT_DOUBLE_EQ(frequencies[3], 3);
  EXPECT_DOUBLE_EQ(frequencies[2], 3 * 0.7 / 0.5);
  EXPECT_DOUBLE_EQ(frequencies[4], 3 * 0.7 / 1.5);
  // Of two the median is their mean, 0.15 m; its frequency, not given, is that of the power law there.
  EXPECT_DOUBLE_EQ(frequencies[5], frequency_of_length(law().group("leaf"), 0.15) * 0.15 / 0.1);
}

TEST(MaterialModel, SaysWhatTheSpeciesLeftOpen) {
  for (const MaterialModel model : {MaterialModel::Constant, MaterialModel::Depth, MaterialModel::Median}) {
    SpeciesLaw open = law();
    open.model.model = model;
    const ModelFrequencies found = model_frequencies(open, kDomains);
    ASSERT_FALSE(found.notes.empty());
    EXPECT_NE(found.notes[0].find("by the power law"), std::string::npos) << found.notes[0];
  }
}

TEST(MaterialModel, NamesAreKnownBothWays) {
  for (const MaterialModel model : kMaterialModels) EXPECT_EQ(model_named(model_name(model)), model);
  EXPECT_NE(model_name_problem("medain").find("did you mean 'median'"), std::string::npos);
  EXPECT_THROW(model_named("linear"), Error);
}

TEST(GroupOf, NameGoesBeforeLevelBeforeKindBeforeTheLevelAbove) {
  SpeciesLaw species = law();
  species.groups["frond"].match = {.name = "frond*"};
  species.groups["second"].match = {.name = "", .kind = {}, .level = 2};
  species.groups["any branch"].match = {.name = "", .kind = DomainKind::Branch};
  const auto group = [&](const std::string& name, DomainKind kind, int level, const std::string& given) {
    return species.group_of(name, kind, level, given);
  };
  EXPECT_EQ(group("frond.3", DomainKind::Branch, 1, "level1"), "frond");
  EXPECT_EQ(group("twig", DomainKind::Branch, 2, "level2"), "second");
  EXPECT_EQ(group("limb", DomainKind::Branch, 1, "level1"), "level1");
  EXPECT_EQ(group("spur", DomainKind::Branch, 3, "level3"), "any branch");
  EXPECT_EQ(group("leaf.1", DomainKind::Leaf, 3, "leaf"), "leaf");
  species.groups.erase("any branch");
  EXPECT_EQ(group("spur", DomainKind::Branch, 3, "level3"), "level3");  // it takes level1's law
  EXPECT_THROW(group("apple", DomainKind::Leaf, 3, "fruit"), Error);
}

TEST(GroupOf, RefusesTwoClaimsOfEqualRight) {
  SpeciesLaw species = law();
  species.groups["a"].match = {.name = "P?"};
  species.groups["b"].match = {.name = "*1"};
  EXPECT_EQ(species.group_of("P2", DomainKind::Branch, 1, "level1"), "a");
  try {
    species.group_of("P1", DomainKind::Branch, 1, "level1");
    FAIL();
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.find("'a'") != std::string::npos && what.find("'b'") != std::string::npos &&
                what.find("'P1'") != std::string::npos)
        << what;
  }
  species.groups["b"].match.level = 1;
  EXPECT_EQ(species.group_of("P1", DomainKind::Branch, 1, "level1"), "b");
}

}  // namespace
}  // namespace liana
