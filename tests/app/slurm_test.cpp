// The manifest as a Slurm array job, with the script that users are given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "tests/support/plants/large_plants.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

using testing::HasSubstr;

constexpr int kUnavailable = 77;

TEST(Slurm, ArrayJobBakesTheManifestAndItsShardsAreMerged) {
  const ScratchFolder folder;
  std::string manifest = "[defaults]\nspecies = \"apple\"\nfolder = \"bakes\"\n";
  for (int i = 0; i < 4; ++i) {
    const std::string name = "p" + std::to_string(i) + ".glb";
    write_instanced_plant(make_branch_hierarchy(3 + i), folder / name);
    manifest += "[[plant]]\nfile = \"" + name + "\"\n";
  }
  manifest += "[[plant]]\nfile = \"gone.glb\"\n";  // in the first shard
  write_file(folder / "plants.toml", manifest);

  const std::string top = LIANA_SOURCE_DIR;
  const std::string command =
      "cd '" + folder.path().string() +
      "' && LIANA='" LIANA_PROGRAM "' XDG_CACHE_HOME=$PWD/cache timeout 120 '" + top +
      "/tests/support/one_node_slurm.sh' \"$PWD/slurm\" sbatch --wait --array=1-2 --mem=300M '" + top +
      "/data/slurm/bake_array.sh' plants.toml > out 2>&1";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  const std::string out = read_file(folder / "out");
  if (WEXITSTATUS(status) == kUnavailable) GTEST_SKIP() << out;
  EXPECT_EQ(WEXITSTATUS(status), 3) << out;  // gone.glb

  const ProgramResult merged = run_liana({"bake", "--manifest", "plants.toml", "--merge"}, folder.path());
  EXPECT_EQ(merged.exit_code, 3);
  EXPECT_THAT(merged.out, HasSubstr("5 plants: 0 baked, 4 kept as they were, 1 failed")) << out;
  const auto summary = nlohmann::json::parse(read_file(folder / "plants.toml.results/summary.json"));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(summary["plants"][i]["domains"], 3 + i);
}

}  // namespace
}  // namespace liana
