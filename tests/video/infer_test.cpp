// From tracks of several points to a species: wind, trunk, branches, law, file.
#include "materials/video/infer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "materials/law/power_law.h"
#include "materials/law/species_writer.h"
#include "materials/video/infer_report.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_tracks.h"

namespace liana {
namespace {

using test::Swing;

struct Branch {
  double length, frequency, damping;
};
const std::vector<Branch> kBranches = {{1.2, 2.1, 0.05}, {0.8, 2.6, 0.06}};
const Swing kTrunk = {0.75, 0.03, 8};

SpeciesFile base() {
  return read_species_file(find_species("palm"));
}

/// Two branches on a trunk: every point sees the trunk's swing and its own.
PointTracks let_go(uint64_t seed, double noise = 0.2) {
  PointTracks tracks = test::tracks_of({}, 30);
  Random random(seed, "plucked");
  for (size_t i = 0; i < kBranches.size(); ++i) {
    const Branch& b = kBranches[i];
    tracks.points.push_back(
        {fmt::format("P{}", i), test::decaying_path({.seconds = 12,
                                                     .angle = 0.3 + double(i),
                                                     .noise = noise,
                                                     .swings = {kTrunk, {b.frequency, b.damping, 9}}},
                                                    random)});
  }
  return tracks;
}

InferOptions two_branches() {
  InferOptions options;
  options.assignments = {{"P0", "level1:1.2"}, {"P1", "level1:0.8"}};
  options.trunk_length = 5;
  return options;
}

std::string complaint(const PointTracks& tracks, const InferOptions& options) {
  try {
    infer(tracks, base().law, nullptr, options);
  } catch (const Error& error) {
    return std::string(error.what()) + " | " + error.hint;
  }
  return "nothing";
}

TEST(Infer, BranchesAreToldFromTheTrunkTheyShare) {
  const InferResult result = infer(let_go(1), base().law, nullptr, two_branches());
  ASSERT_TRUE(result.tree.trunk.has_value());
  EXPECT_FALSE(result.tree.trunk_was_tracked);
  EXPECT_FALSE(result.tree.wind.has_value());
  EXPECT_NEAR(result.tree.trunk->frequency, kTrunk.frequency, 0.01);
  ASSERT_EQ(result.groups.size(), 2u);
  EXPECT_EQ(result.groups[0].group, "level0");
  const FittedGroup& level1 = result.groups[1];
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(level1.branches[i].measured.frequency, kBranches[i].frequency, 0.02);
    EXPECT_NEAR(level1.branches[i].measured.damping_factor, kBranches[i].damping, 0.1 * kBranches[i].damping);
  }
}

TEST(Infer, FittedConstantMinimisesTheTwoNorm) {
  const FittedGroup group = infer(let_go(2), base().law, nullptr, two_branches()).groups.at(1);
  const auto norm = [&](double c1) {
    double squares = 0;
    for (const FittedBranch& b : group.branches)
      squares += std::pow(b.measured.frequency - c1 * std::pow(b.length, group.epsilon1), 2);
    return std::sqrt(squares);
  };
  EXPECT_NEAR(norm(group.c1), group.residual, 1e-12);
  EXPECT_GT(norm(1.001 * group.c1), group.residual);
  EXPECT_GT(norm(0.999 * group.c1), group.residual);
}

TEST(Infer, IntervalsCoverTheTruthInNineOfTenRecords) {
  int trials = 0, covered = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const InferResult result = infer(let_go(seed, 0.5), base().law, nullptr, two_branches());
    for (const BranchMotion& branch : result.tree.branches) {
      const Branch& truth = kBranches[branch.target.length == 1.2 ? 0 : 1];
      ASSERT_TRUE(branch.own.has_value());
      trials += 2;
      covered +=
          std::abs(branch.own->frequency - truth.frequency) < kCoverage95 * branch.own->frequency_sigma;
      covered +=
          std::abs(branch.own->damping_factor - truth.damping) < kCoverage95 * branch.own->damping_sigma;
    }
  }
  EXPECT_GE(covered, 0.9 * trials);
}

TEST(Infer, WindAndAShakenCameraAreTakenOut) {
  // As the palm of [Wang17]: all points share the wind's 0.15 Hz, stronger than anything else, and a shaking
  // hand.
  PointTracks tracks = let_go(3);
  tracks.points.push_back({"rock", std::vector<Vec2>(tracks.frames(), Vec2(20, 400))});
  Random random(3, "hand");
  for (size_t n = 0; n < tracks.frames(); ++n) {
    const Vec2 hand(2 * random.normal(), 2 * random.normal());
    const double wind = 10 * std::sin(2 * kPi * 0.15 * double(n) / 30 + 1);
    for (PointTrack& track : tracks.points)
      track.path[n] += hand + (track.name == "rock" ? Vec2(0, 0) : wind * Vec2(0.8, 0.6));
  }
  InferOptions options = two_branches();
  options.assignments.push_back({"rock", "still"});
  options.motion = {.low = 0.5, .high = 8};
  const InferResult result = infer(tracks, base().law, nullptr, options);
  EXPECT_NEAR(result.tree.trunk->frequency, kTrunk.frequency, 0.02);
  for (size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(result.groups.at(1).branches[i].measured.frequency, kBranches[i].frequency, 0.04);
}

TEST(Infer, LowestSharedFrequencyIsTheWindsWhenAHigherOneIsSharedToo) {
  // Half a minute, so that 0.15 Hz itself is looked at; nothing decays.
  PointTracks tracks = test::tracks_of({}, 30);
  Random random(4, "wind");
  for (size_t i = 0; i < 3; ++i)
    tracks.points.push_back(
        {fmt::format("P{}", i),
         test::decaying_path(
             {.seconds = 30, .swings = {{0.15, 0, 6}, {0.62, 0.004, 4}, {1.1 + 0.25 * double(i), 0.004, 5}}},
             random)});
  InferOptions options;
  options.assignments = {{"P0", "level1:2"}, {"P1", "level1:1.6"}, {"P2", "level1:1.4"}};
  const InferResult result = infer(tracks, base().law, nullptr, options);
  ASSERT_TRUE(result.tree.wind && result.tree.trunk);
  EXPECT_NEAR(result.tree.wind->frequency, 0.15, 0.01);
  EXPECT_NEAR(result.tree.trunk->frequency, 0.62, 0.01);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(result.tree.branches[i].own->frequency, 1.1 + 0.25 * double(i), 0.01);
  EXPECT_FALSE(result.notes.empty());  // the trunk's length is not known
}

TEST(Infer, WrittenSpeciesIsReadBackWithTheFittedLaw) {
  const ScratchFolder folder;
  const SpeciesFile species =
      inferred_species(base(), infer(let_go(5), base().law, nullptr, two_branches()), "mine");
  write_file(folder / "mine.toml", species_toml(species, "Two lines\nof comment"));
  const SpeciesFile back = read_species_file(folder / "mine.toml");
  EXPECT_EQ(back.law.species, "mine");
  const DomainMaterial branch = evaluate(back.law.group("level1"), 1.0),
                       truth = evaluate(species.law.group("level1"), 1.0);
  EXPECT_EQ(branch.frequency, truth.frequency);
  EXPECT_EQ(branch.damping_factor, truth.damping_factor);
  const GroupLaw leaf = base().law.group("leaf");
  EXPECT_EQ(back.law.group("leaf").reference_frequency, leaf.reference_frequency);
  for (const SourcedNumber& number : back.numbers)
    if (number.where == "groups.level1.reference_frequency") {
      EXPECT_NE(number.source.find("made.csv"), std::string::npos);
    }
}

TEST(SpeciesWriter, EveryPresetReadsBackTheSame) {
  const ScratchFolder folder;
  for (const std::string& name : species_names()) {
    SpeciesFile file = read_species_file(find_species(name));
    file.law.model.depth_discount = 0.3;  // and what the presets leave out
    file.law.groups.begin()->second.taper.tip_scaling = 0.5;
    file.law.groups.begin()->second.match = {"frond*", DomainKind::Leaf, 2};
    write_file(folder / "copy.toml", species_toml(file, "copy"));
    const SpeciesLaw back = read_species_file(folder / "copy.toml").law;
    EXPECT_EQ(back.model.model, file.law.model.model);
    EXPECT_EQ(back.model.depth_discount, 0.3);
    ASSERT_EQ(back.groups.size(), file.law.groups.size());
    for (const auto& [key, law] : file.law.groups) {
      const GroupLaw& copy = back.groups.at(key);
      const DomainMaterial a = evaluate(law, 0.7), b = evaluate(copy, 0.7);
      EXPECT_EQ(a.frequency, b.frequency) << name << " " << key;
      EXPECT_EQ(a.mass_scaling, b.mass_scaling) << name << " " << key;
      EXPECT_EQ(a.mass_damping, b.mass_damping) << name << " " << key;
      EXPECT_EQ(a.stiffness_damping, b.stiffness_damping) << name << " " << key;
      EXPECT_EQ(copy.taper.tip_scaling, law.taper.tip_scaling) << name << " " << key;
      EXPECT_EQ(copy.match.name, law.match.name) << name << " " << key;
      EXPECT_EQ(copy.match.kind, law.match.kind) << name << " " << key;
    }
  }
}

TEST(Infer, ReportsAreComplete) {
  const InferResult result = infer(let_go(6), base().law, nullptr, two_branches());
  const auto json = nlohmann::json::parse(infer_json(result));
  for (const char* key : {"source", "frames_per_second", "wind", "trunk", "points", "groups", "notes"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["points"][0]["modes"].size(), 2u);
  EXPECT_NE(infer_table(result).find("level1"), std::string::npos);
  EXPECT_EQ(spectrum_csv(result).substr(0, 31), "point,frequency_hz,amplitude_px");
}

TEST(InferBadInput, TooShortSaysHowLongIsNeeded) {
  PointTracks tracks = let_go(7);
  for (PointTrack& track : tracks.points) track.path.resize(60);
  InferOptions options = two_branches();
  options.motion.low = 0.3;
  const std::string said = complaint(tracks, options);
  EXPECT_NE(said.find("2.00 s only; to find 0.3 Hz, 10.0 s are needed"), std::string::npos) << said;
  for (PointTrack& track : tracks.points) track.path.resize(20);
  EXPECT_NE(complaint(tracks, two_branches()).find("32 frames in a row"), std::string::npos);
}

TEST(InferBadInput, VanishingPointIsNamedAndTheOthersAreUsed) {
  PointTracks tracks = let_go(8);
  for (size_t n = 20; n < tracks.frames(); ++n)
    if (n % 30 > 5) tracks.points[1].path[n].setConstant(std::nan(""));
  const InferResult result = infer(tracks, base().law, nullptr, two_branches());
  EXPECT_EQ(result.left_out, 1u);
  ASSERT_FALSE(result.notes.empty());
  EXPECT_NE(result.notes.front().find("point 'P1' vanishes"), std::string::npos) << result.notes.front();
}

TEST(InferBadInput, NothingMovesOrTheAssignmentMakesNoSense) {
  PointTracks still = let_go(9);
  for (PointTrack& track : still.points)
    for (Vec2& p : track.path) p = Vec2(3, 4);
  EXPECT_NE(complaint(still, two_branches()).find("does not move"), std::string::npos);
  const PointTracks tracks = let_go(9);
  const auto said = [&](const std::string& point, const std::string& target) {
    InferOptions options;
    options.assignments = {{point, target}};
    return complaint(tracks, options);
  };
  EXPECT_NE(said("Q0", "level1:1").find("did you mean 'P0'"), std::string::npos);
  EXPECT_NE(said("P0", "level1:-1").find("metres"), std::string::npos);
  EXPECT_NE(said("P0", "level1:nan").find("metres"), std::string::npos);
  EXPECT_NE(said("P0", "twig").find("no plant is given"), std::string::npos);
  EXPECT_NE(said("P0", "fruit:1").find("no material group 'fruit'"), std::string::npos);
  EXPECT_THROW(parse_assignment("P0"), Error);
  EXPECT_THROW(parse_assignments("P0,level1:1,2\n", "map.csv"), Error);
}

}  // namespace
}  // namespace liana
