#include "materials/law/species_file.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "materials/law/law_numbers.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

constexpr const char* kValid = R"(name = "test"
[default_material]
youngs_modulus = { value = 5e9, source = "s", confidence = "high" }
density = { value = 700, source = "s", confidence = "high" }
poisson_ratio = { value = 0.3, source = "s", confidence = "high" }
[every_group]
reference_length = { value = 2, source = "s", confidence = "low" }
epsilon1 = { value = -0.5, source = "shared", confidence = "low" }
c2 = { value = 1, source = "s", confidence = "low" }
epsilon2 = { value = 0, source = "s", confidence = "low" }
[every_group.damping]
low_frequency = { value = 1, source = "s", confidence = "low" }
high_frequency = { value = 3, source = "s", confidence = "low" }
low_factor = { value = 0.1, source = "s", confidence = "low" }
high_factor = { value = 0.2, source = "s", confidence = "low" }
kappa = { value = 2, source = "s", confidence = "low" }
delta = { value = 2, source = "s", confidence = "guess" }
[groups.level0]
reference_frequency = { value = 1.5, source = "s", confidence = "medium" }
[groups.leaf]
reference_frequency = { value = 4, source = "s", confidence = "medium" }
epsilon1 = { value = -1, source = "own", confidence = "medium" }
)";

std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  const size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return text.replace(at, old_part.size(), new_part);
}

SpeciesFile read_text(const std::string& text) {
  const ScratchFolder folder;
  write_file(folder / "species.toml", text);
  return read_species_file(folder / "species.toml");
}

/// The error that the text is refused with, what and hint.
std::string refusal(const std::string& text) {
  try {
    read_text(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Input);
    return std::string(error.what()) + " | " + error.hint;
  }
  ADD_FAILURE() << "accepted:\n" << text;
  return {};
}

TEST(SpeciesFile, GroupsTakeSharedNumbersUnlessTheyGiveTheirOwn) {
  const SpeciesFile species = read_text(kValid);
  EXPECT_EQ(species.law.species, "test");
  EXPECT_EQ(species.law.default_material.density, 700);
  EXPECT_EQ(species.law.group("level0").epsilon1, -0.5);
  EXPECT_EQ(species.law.group("leaf").epsilon1, -1);
  EXPECT_EQ(species.law.group("leaf").reference_length, 2);
  EXPECT_EQ(species.law.group("leaf").damping.high_factor, 0.2);
  EXPECT_NE(species.hash, 0u);
}

TEST(SpeciesFile, KeepsEveryNumberWithItsSource) {
  const SpeciesFile species = read_text(kValid);
  EXPECT_EQ(species.numbers.size(), 3u + 2 * (5 + 6));
  const auto own =
      std::find_if(species.numbers.begin(), species.numbers.end(),
                   [](const SourcedNumber& number) { return number.where == "groups.leaf.epsilon1"; });
  ASSERT_NE(own, species.numbers.end());
  EXPECT_EQ(own->source, "own");
  EXPECT_EQ(own->confidence, "medium");
}

TEST(SpeciesFile, C1StandsForTheFrequencyAtOneMetre) {
  const GroupLaw law =
      read_text(replaced(kValid, "reference_frequency = { value = 1.5", "c1 = { value = 1.25"))
          .law.group("level0");
  EXPECT_EQ(law.reference_frequency, 1.25);
  EXPECT_EQ(law.reference_length, 1);
}

TEST(SpeciesFile, RefusesC1BesideTheReferenceForm) {
  EXPECT_NE(refusal(replaced(kValid, "[groups.leaf]",
                             "c1 = { value = 1, source = \"s\", confidence = \"low\" }\n[groups.leaf]"))
                .find("one of the two forms"),
            std::string::npos);
}

TEST(SpeciesFile, RefusesAbsurdNumbersWithTheirLine) {
  const auto refused_at = [](const std::string& old_part, const std::string& new_part,
                             const std::string& part) {
    const std::string text = replaced(kValid, old_part, new_part);
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<long>(text.find(new_part)), '\n');
    const std::string message = refusal(text);
    EXPECT_NE(message.find(":" + std::to_string(line) + ":"), std::string::npos) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused_at("density = { value = 700", "density = { value = -700", "density");
  refused_at("density = { value = 700", "density = { value = nan", "nan");
  refused_at("youngs_modulus = { value = 5e9", "youngs_modulus = { value = inf", "youngs_modulus");
  refused_at("poisson_ratio = { value = 0.3", "poisson_ratio = { value = 0.5", "poisson_ratio");
  refused_at("low_factor = { value = 0.1", "low_factor = { value = -0.1", "low_factor");
  refused_at("high_factor = { value = 0.2", "high_factor = { value = 6", "high_factor");
  refused_at("kappa = { value = 2", "kappa = { value = 1.0", "kappa");
  refused_at("reference_length = { value = 2", "reference_length = { value = 0", "reference_length");
  refused_at("density = { value = 700", "density = { value = \"700\"", "number");
  refused_at("density = { value = 700", "density = { valu = 700", "value");
  refused_at("density = { value = 700, source = \"s\"", "density = { value = 700", "source");
  refused_at("density = { value = 700, source = \"s\"", "density = { value = 700, source = \"\"", "source");
  refused_at("confidence = \"guess\"", "confidence = \"sure\"", "confidence");
  refused_at("density = { value = 700, source = \"s\", confidence = \"high\" }", "density = 700", "source");
}

TEST(SpeciesFile, RefusesDeltaOutsideItsBounds) {
  EXPECT_NE(
      refusal(replaced(kValid, "delta = { value = 2", "delta = { value = 2.5")).find("[1/kappa, kappa]"),
      std::string::npos);
  EXPECT_NE(refusal(replaced(kValid, "delta = { value = 2", "delta = { value = 0.4")).find("delta 0.4"),
            std::string::npos);
}

TEST(SpeciesFile, RefusesWhatIsMissingOrUnknown) {
  EXPECT_NE(refusal(replaced(kValid, "name = \"test\"\n", "")).find("name"), std::string::npos);
  EXPECT_NE(refusal(replaced(kValid, "[default_material]", "[material]")).find("default_material"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kValid, "c2 =", "c3 =")).find("c2"), std::string::npos);
  EXPECT_NE(refusal(replaced(kValid, "reference_frequency = { value = 4", "frequency = { value = 4"))
                .find("reference_frequency"),
            std::string::npos);
  const std::string unknown = "colour = \"green\"\n[groups.leaf]";
  EXPECT_NE(refusal(replaced(kValid, "[groups.leaf]", unknown)).find("colour"), std::string::npos);
  EXPECT_NE(refusal("name = \"x\n").find(":1:"), std::string::npos);
  EXPECT_NE(refusal("\x01\x80garbage").find("TOML"), std::string::npos);
}

TEST(SpeciesFile, MissingFileIsNamed) {
  try {
    read_species("nowhere/rose.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere/rose.toml"), std::string::npos);
  }
}

TEST(SpeciesPresets, AreTheSevenAndAllLoadWithSources) {
  for (const char* name : {"apple", "walnut", "birch", "ivy", "liana", "palm", "schefflera"}) {
    SCOPED_TRACE(name);
    const SpeciesFile species = read_species_file(find_species(name));
    EXPECT_EQ(species.law.species, name);
    EXPECT_NO_THROW(check(species.law, name));
    EXPECT_NO_THROW(species.law.group("leaf"));
    EXPECT_NO_THROW(species.law.group("level9"));
    EXPECT_EQ(species.numbers.size(), 3 + 11 * species.law.groups.size());
    for (const SourcedNumber& number : species.numbers) EXPECT_GT(number.source.size(), 8u) << number.where;
  }
}

// Small trees 1-3 Hz, branches 0.5-5 Hz, leaves on petioles 2-10 Hz.
TEST(SpeciesPresets, TreesSwingWithinTheFieldsRanges) {
  for (const char* name : {"apple", "walnut", "birch"}) {
    SCOPED_TRACE(name);
    const SpeciesLaw law = read_species(name);
    const DomainMaterial trunk = evaluate(law.group("level0"), 2.5), limb = evaluate(law.group("level1"), 1);
    const DomainMaterial leaf = evaluate(law.group("leaf"), 0.08);
    EXPECT_TRUE(trunk.frequency >= 1 && trunk.frequency <= 3) << trunk.frequency;
    EXPECT_TRUE(limb.frequency >= 0.5 && limb.frequency <= 5) << limb.frequency;
    EXPECT_TRUE(leaf.frequency >= 2 && leaf.frequency <= 10) << leaf.frequency;
    EXPECT_TRUE(trunk.damping_factor >= 0.03 && limb.damping_factor <= 0.15);
    EXPECT_TRUE(leaf.damping_factor >= 0.1 && leaf.damping_factor <= 0.3);
  }
}

// Tables 1 and 2 of [Wang17]: the frequencies measured in the videos, and the damping there.
TEST(SpeciesPresets, PalmAndScheffleraReproduceThePapersTables) {
  const SpeciesLaw palm = read_species("palm"), schefflera = read_species("schefflera");
  const GroupLaw &trunk = palm.group("level0"), &frond = palm.group("level1"),
                 &stem = schefflera.group("level0");
  EXPECT_NEAR(evaluate(trunk, trunk.reference_length).frequency, (0.75 + 0.6 + 0.6 + 0.6) / 4, 1e-12);
  EXPECT_NEAR(evaluate(frond, frond.reference_length).frequency, (0.9 + 1.35 + 1.05 + 0.9 + 1.2) / 5, 1e-12);
  EXPECT_NEAR(evaluate(stem, stem.reference_length).frequency, 1.71, 1e-12);
  EXPECT_EQ(evaluate(trunk, trunk.reference_length).damping_factor, 0.0065);
  EXPECT_EQ(trunk.c2, 10);
  EXPECT_EQ(palm.group("leaf").c2, 8.5);
  EXPECT_EQ(stem.epsilon2, 1.5);
  EXPECT_EQ(stem.damping.kappa, 5);
  EXPECT_EQ(stem.damping.delta, 0.25);
}

TEST(FindSpecies, SuggestsTheNearestNameAndListsAll) {
  try {
    find_species("aple");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("aple"), std::string::npos);
    EXPECT_NE(error.hint.find("did you mean 'apple'"), std::string::npos) << error.hint;
    EXPECT_NE(error.hint.find("schefflera"), std::string::npos);
  }
}

TEST(FindSpecies, LooksInLianaDataFirst) {
  const ScratchFolder folder;
  fs::create_directories(folder / "species");
  write_file(folder / "species/apple.toml", kValid);
  setenv("LIANA_DATA", (folder / "").c_str(), 1);
  EXPECT_EQ(read_species("apple").species, "test");
  unsetenv("LIANA_DATA");
  EXPECT_EQ(read_species("apple").species, "apple");
}

}  // namespace
}  // namespace liana
