// liana bake --manifest: libraries of plants.
#include "runtime/app/bake/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "materials/bake/bake_file.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "tests/support/plants/large_plants.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Manifest : public testing::Test {
 protected:
  /// Plants p0.glb, p1.glb, ... of a few branches each.
  void add_plants(int count, int branches = 4) {
    for (int i = 0; i < count; ++i)
      write_instanced_plant(make_branch_hierarchy(branches + i),
                            folder_ / ("p" + std::to_string(i) + ".glb"));
  }
  static std::string entry(const std::string& lines) { return "[[plant]]\n" + lines + "\n"; }
  static std::string list(int count) {
    std::string text = "[defaults]\nspecies = \"apple\"\nfolder = \"bakes\"\n";
    for (int i = 0; i < count; ++i) text += entry("file = \"p" + std::to_string(i) + ".glb\"");
    return text;
  }
  fs::path write(const std::string& text) {
    write_file(folder_ / "plants.toml", text);
    return folder_ / "plants.toml";
  }
  ProgramResult run(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"bake", "--manifest", "plants.toml"});
    return run_liana(more, folder_.path());
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(read_file(folder_ / "plants.toml.results/summary.json"));
  }
  std::string state(size_t item) const { return summary()["plants"][item]["state"]; }

  ScratchFolder folder_;
};

TEST_F(Manifest, BakesEveryPlantAsTheVerbAloneDoes) {
  add_plants(3);
  write(list(2) + entry("file = \"p2.glb\"\nspecies = \"birch\"\noutput = \"own.bake\"\n"
                        "set = [\"level0.reference_frequency=1.25\"]"));
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 plants: 3 baked"));
  EXPECT_EQ(read_bake(folder_ / "bakes/p1.bake").domains.size(), 5u);
  const ProgramResult alone = run_liana({"bake", folder_ / "p2.glb", "--species", "birch", "-o", "alone.bake",
                                         "--set", "level0.reference_frequency=1.25"},
                                        folder_.path());
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(read_file(folder_ / "alone.bake"), read_file(folder_ / "own.bake"));
}

TEST_F(Manifest, KeepsWhatIsBakedAndBakesWhatChanged) {
  add_plants(3);
  write(list(3));
  ASSERT_EQ(run().exit_code, 0);
  const fs::file_time_type written = fs::last_write_time(folder_ / "bakes/p0.bake");
  write_file(folder_ / "bakes/p1.bake", "not what was baked");
  write_instanced_plant(make_branch_hierarchy(9), folder_ / "p2.glb");
  EXPECT_THAT(run().out, HasSubstr("2 baked, 1 kept"));
  EXPECT_EQ(state(0), "kept");
  EXPECT_EQ(state(1), "baked");
  EXPECT_EQ(state(2), "baked");
  EXPECT_EQ(fs::last_write_time(folder_ / "bakes/p0.bake"), written);
  EXPECT_EQ(read_bake(folder_ / "bakes/p2.bake").domains.size(), 9u);
  write(list(2) + entry("file = \"p2.glb\"\nset = [\"level0.c2=1.1\"]"));
  EXPECT_THAT(run().out, HasSubstr("1 baked, 2 kept"));
}

TEST_F(Manifest, OneFailureDoesNotStopTheRest) {
  add_plants(3);
  write_file(folder_ / "p1.glb", "no plant");
  write(list(3) + entry("file = \"gone.glb\"") +
        entry("file = \"p0.glb\"\nspecies = \"aple\"\noutput = \"x.bake\"") +
        entry("file = \"p0.glb\"\noptions = [\"--no-such-option\"]\noutput = \"y.bake\""));
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.out, HasSubstr("6 plants: 2 baked, 0 kept as they were, 4 failed"));
  EXPECT_EQ(state(0), "baked");
  EXPECT_EQ(state(2), "baked");
  for (const size_t failed : {1, 3, 4, 5}) EXPECT_EQ(state(failed), "failed") << failed;
  EXPECT_THAT(summary()["plants"][1]["message"], HasSubstr("p1.glb"));
  EXPECT_THAT(summary()["plants"][3]["message"], HasSubstr("no such file"));
  EXPECT_THAT(summary()["plants"][4]["message"], HasSubstr("aple"));
  EXPECT_FALSE(fs::exists(folder_ / "bakes/p1.bake"));
}

TEST_F(Manifest, ShardsTogetherBakeAllAndAreMerged) {
  add_plants(5);
  write(list(5));
  EXPECT_EQ(run({"--shard", "1/2"}).exit_code, 0);
  const ProgramResult half = run({"--merge"});
  EXPECT_EQ(half.exit_code, 3);
  EXPECT_THAT(half.out, HasSubstr("2 not baked yet"));
  EXPECT_EQ(run({"--shard", "2/2"}).exit_code, 0);
  const ProgramResult whole = run({"--merge"});
  EXPECT_EQ(whole.exit_code, 0) << whole.out;
  EXPECT_THAT(whole.out, HasSubstr("5 plants: 0 baked, 5 kept"));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(summary()["plants"][i]["domains"], 4 + i);
  for (const char* wrong : {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2x"})
    EXPECT_EQ(run({"--shard", wrong}).exit_code, 2) << wrong;
}

TEST_F(Manifest, EqualOutputsAreRefusedNamingBothLines) {
  add_plants(2);
  write(list(2) + entry("file = \"p1.glb\"\noutput = \"./bakes/../bakes/p0.bake\""));
  const ProgramResult result = run();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("plants.toml: the plants of lines 4 and 8 have the same output"));
  EXPECT_FALSE(fs::exists(folder_ / "bakes"));
}

TEST_F(Manifest, MistakesAreNamedWithTheirLine) {
  const auto said = [&](const std::string& text) -> std::string {
    try {
      read_manifest(write(text));
    } catch (const Error& error) {
      return std::string(error.what()) + " | " + error.hint;
    }
    return "nothing";
  };
  EXPECT_THAT(said(""), HasSubstr("no [[plant]]"));
  EXPECT_THAT(said("[[plant]]\nspecies = \"apple\""), HasSubstr("plants.toml:1: 'file' is missing"));
  EXPECT_THAT(said("[[plant]]\nfile = \"a.glb\""), HasSubstr("'species' is missing"));
  EXPECT_THAT(said(list(0) + "[[plant]]\nfiel = \"a.glb\""), HasSubstr("'file' is missing"));
  EXPECT_THAT(said(list(1) + "oputput = \"b\""), HasSubstr("plants.toml:6: 'oputput' is not known"));
  EXPECT_THAT(said(list(1) + "options = [\"--report=x\"]"), HasSubstr("--report"));
  EXPECT_THAT(said(list(1) + "options = \"--strict\""), HasSubstr("list of texts"));
  EXPECT_THAT(said("[[plant"), HasSubstr("plants.toml:1"));
}

TEST_F(Manifest, OptionsOfASinglePlantDoNotGoWithIt) {
  write(list(1));
  const ProgramResult result = run({"--strict"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--strict"));
}

// Interrupted in the middle: what is there is complete, and the next run does the rest.
TEST_F(Manifest, InterruptLeavesFinishedBakesAndTheNextRunGoesOn) {
  add_plants(8, 30);
  write(list(8));
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder_.path().c_str()) != 0) _exit(127);
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    if (!freopen("/dev/null", "w", stdout) || !freopen("err", "w", stderr)) _exit(127);
    execl(LIANA_PROGRAM, LIANA_PROGRAM, "bake", "--manifest", "plants.toml", "--jobs", "1", nullptr);
    _exit(127);
  }
  const auto finished = [&] {
    size_t count = 0;
    for (int i = 0; i < 8; ++i) count += fs::exists(folder_ / ("bakes/p" + std::to_string(i) + ".bake"));
    return count;
  };
  while (finished() < 2 && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130) << read_file(folder_ / "err");
  EXPECT_THAT(read_file(folder_ / "err"), HasSubstr("of 8 plants"));
  EXPECT_LT(finished(), 8u);
  for (const auto& left : fs::recursive_directory_iterator(folder_ / "bakes")) {
    EXPECT_THAT(left.path().string(), Not(HasSubstr("partial")));
    EXPECT_NO_THROW(read_bake(left.path()));
  }
  EXPECT_EQ(run().exit_code, 0);
  EXPECT_EQ(state(0), "kept");
  EXPECT_EQ(finished(), 8u);
}

}  // namespace
}  // namespace liana
