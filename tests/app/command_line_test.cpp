// The program itself: exit codes, messages, and what is left behind.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "materials/bake/bake_file.h"
#include "mesher/base/files.h"
#include "mesher/io/plant_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code;
  std::string text;  ///< stdout and stderr
};

std::string quoted(const fs::path& path) {
  return "'" + path.string() + "'";
}

/// A shell line in which $L is the program.
Outcome shell(const std::string& line) {
  FILE* pipe = popen(("exec 2>&1; L=" + quoted(LIANA_PROGRAM) + "; " + line).c_str(), "r");
  Outcome outcome{-1, {}};
  char buffer[4096];
  for (size_t size; (size = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, size);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

testing::AssertionResult says(const Outcome& outcome, const std::string& part) {
  if (outcome.text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in:\n" << outcome.text;
}

size_t files_in(const ScratchFolder& folder) {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder / "")) count += entry.is_regular_file();
  return count;
}

class CommandLine : public testing::Test {
 protected:
  CommandLine() : plant_(folder_ / "a plant.glb") { write_plant(make_small_plant(), plant_); }

  std::string bake(const std::string& rest) const { return "\"$L\" bake " + quoted(plant_) + " " + rest; }

  ScratchFolder folder_;
  fs::path plant_;
};

TEST_F(CommandLine, HelpTeachesWithExamples) {
  for (const char* line : {"\"$L\" --help", "\"$L\" bake --help", "\"$L\" inspect --help"}) {
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(says(outcome, "Example"));
  }
  EXPECT_TRUE(says(shell("\"$L\" --version"), "liana 0."));
}

TEST_F(CommandLine, UsageErrorsAreTwoAndHelp) {
  EXPECT_EQ(shell("\"$L\"").code, 2);
  const Outcome typo = shell("\"$L\" bkae x");
  EXPECT_EQ(typo.code, 2);
  EXPECT_TRUE(says(typo, "there is no verb 'bkae'"));
  EXPECT_TRUE(says(typo, "liana bake"));
  EXPECT_EQ(shell("\"$L\" bake").code, 2);
  EXPECT_EQ(shell(bake("--species apple --nonsense")).code, 2);
  EXPECT_EQ(shell(bake("--species apple --threads -1")).code, 2);
  EXPECT_EQ(shell(bake("--species apple --element T9")).code, 2);
  EXPECT_EQ(shell(bake("--species apple --set leaf.c2")).code, 2);
  EXPECT_EQ(shell("\"$L\" inspect").code, 2);
}

TEST_F(CommandLine, BakesAndInspectsWhatItBaked) {
  const fs::path output = folder_ / "out.bake", report = folder_ / "report.json";
  const Outcome baked = shell(bake("--species apple -o " + quoted(output) + " --report " + quoted(report)));
  ASSERT_EQ(baked.code, 0) << baked.text;
  EXPECT_TRUE(says(baked, "13 domains"));
  EXPECT_TRUE(says(baked, "seconds: read"));
  EXPECT_EQ(baked.text.find('\033'), std::string::npos);  // nobody watches
  for (const auto& [file, part] : {std::pair(output, fmt::format("a bake (version {})", kBakeVersion)),
                                   std::pair(report, std::string("report of liana bake")),
                                   std::pair(plant_, std::string("13 domains"))}) {
    const Outcome inspected = shell("\"$L\" inspect --domains " + quoted(file));
    EXPECT_EQ(inspected.code, 0);
    EXPECT_TRUE(says(inspected, part));
  }
}

TEST_F(CommandLine, WritesBesideNothingWhenTheNameIsLeftOut) {
  ASSERT_EQ(shell("cd " + quoted(folder_ / "") + " && " + bake("--species apple")).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "a plant.bake"));
}

TEST_F(CommandLine, UnknownSpeciesSuggestsTheNearest) {
  const Outcome outcome = shell(bake("--species aple -o " + quoted(folder_ / "x.bake")));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome, "did you mean 'apple'"));
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(CommandLine, BadPlantsAreOneMessageAndNoFile) {
  write_file(folder_ / "cut.glb", read_file(plant_).substr(0, 1000));
  write_file(folder_ / "random.glb", std::string("\x8f\x01\x02not a plant at all"));
  for (const char* name : {"cut.glb", "random.glb", "absent.glb"}) {
    const Outcome outcome =
        shell("\"$L\" bake " + quoted(folder_ / name) + " --species apple -o " + quoted(folder_ / "x.bake"));
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_TRUE(says(outcome, name));
    EXPECT_FALSE(fs::exists(folder_ / "x.bake"));
  }
}

TEST_F(CommandLine, OutputThatCannotBeWrittenIsSaidAtOnce) {
  const Outcome outcome = shell(bake("--species apple -o " + quoted(folder_ / "no/such/x.bake")));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome, "no such folder"));
  EXPECT_EQ(outcome.text.find("surface"), std::string::npos);
}

// A domain of flat slivers: nothing to make solid. Three: baked, but for what is named; strict: not at all.
TEST_F(CommandLine, PartialBakeIsThreeAndStrictIsOne) {
  SegmentedPlant plant = make_small_plant();
  plant.domains.back().name = "broken";
  plant.domains.back().kind = DomainKind::Branch;
  plant.domains.back().surface = {{Vec3(0, 1, 0), Vec3(0, 1, 1e-9), Vec3(0, 1.1, 0)}, {{0, 1, 2}}};
  write_plant(plant, plant_);
  const std::string output = "--species apple -o " + quoted(folder_ / "x.bake");
  const Outcome strict = shell(bake(output + " --strict"));
  EXPECT_EQ(strict.code, 1) << strict.text;
  EXPECT_FALSE(fs::exists(folder_ / "x.bake"));
  const Outcome partial = shell(bake(output));
  EXPECT_EQ(partial.code, 3) << partial.text;
  EXPECT_TRUE(says(partial, "broken"));
  EXPECT_TRUE(fs::exists(folder_ / "x.bake"));
}

TEST_F(CommandLine, CtrlCLeavesNoFile) {
  // Many plants of different proportions, so that it is still at work when the signal comes.
  SegmentedPlant plant = make_small_plant(), many;
  for (int copy = 0; copy < 150; ++copy)
    for (const Domain& domain : plant.domains) {
      many.domains.push_back(domain);
      for (Vec3& p : many.domains.back().surface.positions) p.y() *= 1 + 0.01 * copy;
      if (!domain.parent.valid()) continue;
      many.domains.back().parent = DomainId(domain.parent.index() + plant.domains.size() * copy);
    }
  write_plant(many, plant_);
  const Outcome outcome = shell(bake("--species apple -o " + quoted(folder_ / "x.bake")) +
                                " & P=$!; sleep 0.4; kill -INT $P; wait $P");
  EXPECT_EQ(outcome.code, 130) << outcome.text;
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(CommandLine, InspectSaysWhatItUnderstands) {
  write_file(folder_ / "notes.txt", "nothing of ours");
  const Outcome outcome = shell("\"$L\" inspect " + quoted(folder_ / "notes.txt"));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome, ".bake"));
  EXPECT_TRUE(says(shell("\"$L\" inspect --species"), "schefflera"));
  EXPECT_TRUE(says(shell("\"$L\" inspect --species apple"), "Niklas"));
  EXPECT_TRUE(says(shell("\"$L\" inspect --species apple"), "model   power"));
  EXPECT_TRUE(says(shell("\"$L\" inspect --species schefflera"), "claims name \"P0\""));
}

}  // namespace
}  // namespace liana
