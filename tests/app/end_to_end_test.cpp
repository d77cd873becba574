// The whole data flow as a user runs it: bake, verify, simulate.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "runtime/picture/image.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

const fs::path kData = LIANA_SOURCE_DIR "/data";

class EndToEnd : public testing::Test {
 protected:
  void run(const std::vector<std::string>& arguments) {
    const ProgramResult result = run_liana(arguments, folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  }
  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(read_file(folder_ / name));
  }
  void bake(const std::string& plant, const std::string& species) {
    run({"bake", kData / "plants" / (plant + ".glb"), "--species", species, "-o", plant + ".bake", "--report",
         plant + ".json"});
  }

  ScratchFolder folder_;
};

/// What every domain was baked with is what its motion shows at the paper's 25 ms.
void expect_closed_loop(const nlohmann::json& verified, const nlohmann::json& report) {
  ASSERT_EQ(verified["domains"].size(), report["domains"].size());
  for (size_t i = 0; i < verified["domains"].size(); ++i) {
    const auto& measured = verified["domains"][i];
    const auto& baked = report["domains"][i];
    EXPECT_EQ(measured["id"], baked["id"]);
    EXPECT_NEAR(measured["nu_measured"].get<double>() / baked["nu_hz"].get<double>(), 1, 0.01) << measured;
    const double xi = baked["xi"];
    EXPECT_NEAR(measured["xi_measured"].get<double>(), xi, xi < 0.02 ? 0.002 : 0.05 * xi) << measured;
  }
}

TEST_F(EndToEnd, BothShippedTreesMoveAsBaked) {
  for (const std::string plant : {"apple_small", "apple_tree"}) {
    bake(plant, "apple");
    run({"verify", plant + ".bake", "--json", "verify.json"});
    expect_closed_loop(json("verify.json"), json(plant + ".json"));
  }
}

TEST_F(EndToEnd, ReportHasItsStableKeys) {
  bake("apple_small", "apple");
  const nlohmann::json report = json("apple_small.json");
  for (const char* key : {"plant", "species", "seconds", "domains"}) EXPECT_TRUE(report.contains(key)) << key;
  for (const char* key : {"read", "surface", "tets", "modal", "laws", "total"})
    EXPECT_TRUE(report["seconds"].contains(key)) << key;
  for (const char* key : {"id",        "name",    "parent", "kind",          "level", "group",   "length_m",
                          "mass_kg",   "tets",    "dof",    "nu_default_hz", "nu_hz", "alpha_k", "alpha_m",
                          "youngs_pa", "density", "xi",     "d_m",           "d_k",   "route",   "solved_as"})
    for (const auto& domain : report["domains"]) EXPECT_TRUE(domain.contains(key)) << key;
}

TEST_F(EndToEnd, SimulationIsTheSameOnOneThreadAndTwoAndAgain) {
  bake("apple_small", "apple");
  write_file(folder_ / "scene.toml",
             "[wind]\nvelocity = [2, 0, 1]\n"
             "[[obstacle]]\nbox = { center = [0, 1, -0.1], size = [2, 2, 0.2] }\n"
             "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0.04]\n"
             "[[plant]]\nbake = \"apple_small.bake\"\nposition = [1.5, 0, 0.5]\n");
  std::vector<std::string> hashes;
  for (const char* threads : {"1", "2", "2"}) {
    run({"simulate", "scene.toml", "--seconds", "6", "--threads", threads, "--report", "report.json"});
    hashes.push_back(json("report.json")["state_hash"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[1], hashes[2]);
  EXPECT_EQ(json("report.json")["steps"], 240);
  EXPECT_GT(json("report.json")["anchors"], 0);
  EXPECT_LT(json("report.json")["max_penetration_m"], 2e-3);
}

TEST_F(EndToEnd, RecordedRunIsReplayedOrItsFirstDifferenceNamed) {
  const std::string climber = "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0]\n";
  write_file(folder_ / "scene.toml", "[wind]\nvelocity = [2, 0, 1]\n" + climber);
  run({"simulate", "scene.toml", "--seconds", "2", "--record", "a.session"});
  run({"simulate", "scene.toml", "--replay", "a.session", "--threads", "1", "--report", "report.json"});
  EXPECT_EQ(json("report.json")["steps"], 80);
  write_file(folder_ / "scene.toml", "[wind]\nvelocity = [2.1, 0, 1]\n" + climber);
  const ProgramResult other = run_liana({"simulate", "scene.toml", "--replay", "a.session"}, folder_.path());
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("a.session:2: step 1 is the first that differs"), std::string::npos) << other.err;
  EXPECT_EQ(run_liana({"simulate", "scene.toml", "--record", "/dev/full"}, folder_.path()).exit_code, 1);
}

TEST_F(EndToEnd, SimulateWritesPictureVideoAndModel) {
  write_file(folder_ / "scene.toml", "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0]\n");
  run({"simulate", "scene.toml", "--seconds", "0.5", "--png", "a.png", "--size", "320", "180", "--mp4",
       "a.mp4", "--video-seconds", "0.2", "--video-size", "160", "90", "--export", "a.glb"});
  EXPECT_EQ(read_png(folder_ / "a.png").width, 320);
  EXPECT_EQ(read_file(folder_ / "a.glb").substr(0, 4), "glTF");
  EXPECT_EQ(read_file(folder_ / "a.mp4").substr(4, 4), "ftyp");
}

}  // namespace
}  // namespace liana
