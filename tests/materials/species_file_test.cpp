#include "materials/law/species_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/law/law_numbers.h"
#include "materials/law/power_law.h"
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

TEST(SpeciesFile, AllGroupsMayShareC1) {
  std::string text = replaced(kValid, "reference_length = { value = 2", "c1 = { value = 1.25");
  text = replaced(text, "reference_frequency = { value = 1.5, source = \"s\", confidence = \"medium\" }", "");
  text = replaced(text, "[groups.leaf]\n",
                  "[groups.leaf]\nreference_length = { value = 3, source = \"s\", confidence = \"low\" }\n");
  const SpeciesFile species = read_text(text);
  EXPECT_EQ(species.law.group("level0").reference_frequency, 1.25);
  EXPECT_EQ(species.law.group("level0").reference_length, 1);
  EXPECT_EQ(species.law.group("leaf").reference_frequency, 4);
  EXPECT_EQ(species.law.group("leaf").reference_length, 3);
}

TEST(SpeciesFile, DampingMayBeConstantRayleigh) {
  const std::string own =
      "[groups.leaf.damping]\n"
      "mass_damping = { value = 0.5, source = \"s\", confidence = \"low\" }\n"
      "stiffness_damping = { value = 0.03, source = \"s\", confidence = \"low\" }\n";
  const SpeciesLaw law = read_text(kValid + own).law;
  EXPECT_FALSE(law.group("level0").damping.constant_rayleigh);
  const DomainMaterial leaf = evaluate(law.group("leaf"), 1.7);
  EXPECT_EQ(leaf.mass_damping, 0.5);
  EXPECT_EQ(leaf.stiffness_damping, 0.03);
  EXPECT_DOUBLE_EQ(leaf.damping_factor,  // [Wang17] Eq. 12
                   0.5 * (0.5 / (2 * kPi * leaf.frequency) + 2 * kPi * 0.03 * leaf.frequency));
  EXPECT_NE(refusal(kValid + own + "low_factor = { value = 1, source = \"s\", confidence = \"low\" }\n")
                .find("one of the two forms"),
            std::string::npos);
  EXPECT_NE(refusal(kValid + replaced(own, "mass_damping", "mas_damping")).find("mass_damping"),
            std::string::npos);
}

// [Wang17] Eq. 11.
TEST(SpeciesFile, GroupsMayTaper) {
  const auto with = [](const std::string& numbers) { return std::string(kValid) + numbers; };
  const auto line = [](const char* key, double value) {
    return std::string(key) + " = { value = " + std::to_string(value) +
           ", source = \"s\", confidence = \"low\" }\n";
  };
  const SpeciesLaw law = read_text(with(line("s_max", 1.5) + line("s_min", 0.25) + line("epsilon3", 3))).law;
  EXPECT_EQ(law.group("leaf").taper, (TaperLaw{1.5, 0.25, 3}));
  EXPECT_TRUE(law.group("level0").taper.uniform());
  const size_t lines = static_cast<size_t>(std::count(kValid, kValid + std::string(kValid).size(), '\n'));
  for (const auto& [key, value] : {std::pair("s_max", 0.0), {"s_min", -1.0}, {"epsilon3", -2.0}}) {
    const std::string said = refusal(with(line(key, value)));
    EXPECT_NE(said.find("species.toml:" + std::to_string(lines + 1) + ": '" + key), std::string::npos)
        << said;
  }
  EXPECT_NE(refusal(with("s_min = 0.5\n")).find("has no source"), std::string::npos);
  EXPECT_NE(refusal(with(line("s_mim", 0.5))).find("s_m"), std::string::npos);
}

TEST(SpeciesFile, GroupsMayClaimDomains) {
  const auto with_match = [](const std::string& match) {
    return replaced(kValid, "[groups.leaf]\n", "[groups.leaf]\nmatch = { " + match + " }\n");
  };
  const GroupMatch match =
      read_text(with_match("name = \"frond*\", kind = \"branch\", level = 1")).law.group("leaf").match;
  EXPECT_EQ(match.name, "frond*");
  EXPECT_EQ(match.kind, DomainKind::Branch);
  EXPECT_EQ(match.level, 1);
  EXPECT_TRUE(read_text(kValid).law.group("leaf").match.empty());
  for (const auto& [bad, part] : {std::pair("kind = \"root\"", "leaf"),
                                  {"nam = \"x\"", "name"},
                                  {"", "matches nothing"},
                                  {"level = -1", "level"},
                                  {"level = 1.5", "whole"},
                                  {"name = 3", "text"}})
    EXPECT_NE(refusal(with_match(bad)).find(part), std::string::npos)
        << bad << ": " << refusal(with_match(bad));
}

TEST(SpeciesFile, NamesItsModel) {
  const std::string model =
      "[model]\nname = \"depth\"\ndepth_scale = { value = 400, source = \"s\", confidence = \"low\" }\n";
  EXPECT_EQ(read_text(kValid).law.model.model, MaterialModel::PowerLaw);
  EXPECT_EQ(read_text(kValid + model).law.model.model, MaterialModel::Depth);
  EXPECT_EQ(read_text(kValid + model).law.model.depth_scale, 400);
  EXPECT_EQ(read_text(kValid + model).law.model.depth_discount, 0.1);
  EXPECT_NE(refusal(kValid + replaced(model, "depth\"", "dept\"")).find("did you mean 'depth'"),
            std::string::npos);
  EXPECT_NE(refusal(kValid + replaced(model, "depth_scale", "depth_scal")).find("depth_scale"),
            std::string::npos);
  EXPECT_NE(refusal(kValid + replaced(model, "value = 400", "value = -1")).find("depth_scale"),
            std::string::npos);
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

TEST(SpeciesPresets, AllLoadWithASourceForEveryNumber) {
  EXPECT_EQ(species_names(),
            (std::vector<std::string>{"apple", "birch", "ivy", "liana", "palm", "schefflera", "walnut",
                                      "wang17_broadleaf", "wang17_bush", "wang17_conifer", "wang17_figure16",
                                      "wang17_fir", "wang17_full_fem", "wang17_hemlock"}));
  for (const std::string& name : species_names()) {
    SCOPED_TRACE(name);
    const SpeciesFile species = read_species_file(find_species(name));
    EXPECT_EQ(species.law.species, name);
    EXPECT_NO_THROW(check(species.law, name));
    EXPECT_NO_THROW(species.law.group("leaf"));
    EXPECT_NO_THROW(species.law.group("level9"));
    EXPECT_GE(species.numbers.size(), 3 + 7 * species.law.groups.size());
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

// [Wang17] Table 1, its last columns.
TEST(SpeciesPresets, HaveTheExponentsAndDampingOfThePapersTable1) {
  struct Row {
    const char* name;
    double epsilon1, epsilon2;
    bool constant;
    double damping[4];  // ν_low, ν_high, ξ_low, ξ_high, or d_M, d_K
    double kappa = 2, delta = 2;
  };
  const Row rows[] = {{"wang17_conifer", 0, 0, true, {0, 0.03}},
                      {"schefflera", -0.59, 1.5, false, {2.8, 4, 0.04, 0.6}, 5, 0.25},
                      {"wang17_full_fem", -0.59, 0.7, true, {0, 0.002}},
                      {"wang17_broadleaf", -0.59, 0.2, false, {0.5, 1, 0.05, 0.12}},
                      {"wang17_fir", -0.1, 0, false, {1, 5, 0.15, 0.15}},
                      {"wang17_bush", -0.1, 0, true, {0, 0.015}},
                      {"wang17_hemlock", 0, 0, true, {0, 0.03}},
                      {"palm", -0.59, 1.5, false, {1, 3, 0.0065, 0.1}}};
  for (const Row& row : rows)
    for (const auto& [name, group] : read_species(row.name).groups) {
      SCOPED_TRACE(std::string(row.name) + " " + name);
      const DampingLaw& damping = group.damping;
      EXPECT_EQ(group.epsilon1, row.epsilon1);
      EXPECT_EQ(group.epsilon2, row.epsilon2);
      ASSERT_EQ(damping.constant_rayleigh, row.constant);
      if (row.constant) {
        EXPECT_EQ(damping.mass_damping, row.damping[0]);
        EXPECT_EQ(damping.stiffness_damping, row.damping[1]);
        continue;
      }
      EXPECT_EQ(damping.low_frequency, row.damping[0]);
      EXPECT_EQ(damping.high_frequency, row.damping[1]);
      EXPECT_EQ(damping.low_factor, row.damping[2]);
      EXPECT_EQ(damping.high_factor, row.damping[3]);
      EXPECT_EQ(damping.kappa, row.kappa);
      EXPECT_EQ(damping.delta, row.delta);
    }
}

/// The C₁ of Eq. 8 nearest to frequencies of branches in the 2-norm: Σ ν ℓ^ε₁ / Σ ℓ^2ε₁ ([Wang17] §7).
double nearest_c1(const std::vector<double>& frequencies, const std::vector<double>& lengths,
                  double epsilon1) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < frequencies.size(); ++i) {
    const double power = std::pow(lengths[i], epsilon1);
    sum += frequencies[i] * power, squares += power * power;
  }
  return sum / squares;
}

double c1(const GroupLaw& law) {
  return frequency_of_length(law, 1);
}

// Table 2 of [Wang17] gives the frequencies and the text how C₁ follows: the 2-norm for the palm's fronds,
// directly for its trunk (P0 shows none), directly for the tracked branches of the schefflera and their mean
// for the others. The lengths are the presets' own: the paper prints none.
TEST(SpeciesPresets, SolveC1FromThePapersTable2) {
  const SpeciesLaw palm = read_species("palm"), schefflera = read_species("schefflera");
  const GroupLaw &trunk = palm.group("level0"), &frond = palm.group("level1");
  const std::vector<double> fronds = {0.9, 1.35, 1.05, 0.9, 1.2}, trunks = {0.75, 0.6, 0.6, 0.6};
  const auto repeat = [](size_t times, double value) { return std::vector<double>(times, value); };
  EXPECT_NEAR(c1(frond), nearest_c1(fronds, repeat(5, frond.reference_length), frond.epsilon1), 1e-12);
  EXPECT_NEAR(c1(trunk), nearest_c1(trunks, repeat(4, trunk.reference_length), trunk.epsilon1), 1e-12);

  const GroupLaw &stem = schefflera.group("level0"), &branch = schefflera.group("level1");
  EXPECT_NEAR(c1(stem), nearest_c1({1.71}, {stem.reference_length}, stem.epsilon1), 1e-12);
  const double tracked[] = {2.45, 3.18, 2.69};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const std::string name = "P" + std::to_string(i);
    const GroupLaw& group = schefflera.group(schefflera.group_of(name, DomainKind::Branch, 1, "level1"));
    EXPECT_NEAR(c1(group), nearest_c1({tracked[i]}, {group.reference_length}, group.epsilon1), 1e-12);
    sum += c1(group);
  }
  EXPECT_NEAR(c1(branch), sum / 3, 1e-12);
  EXPECT_EQ(schefflera.group_of("branch.7", DomainKind::Branch, 1, "level1"), "level1");
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
