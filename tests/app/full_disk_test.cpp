// A disk that is full: one message, nothing half-written, what was there stays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include <cstdlib>

#include "mesher/base/files.h"
#include "tests/support/plants/large_plants.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A file system of 64 kB beside a plant whose bake takes about twice that.
class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(disk_);
    mounted_ = mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=64k") == 0;
    if (!mounted_) GTEST_SKIP() << "mounting is not allowed here";
    write_instanced_plant(make_branch_hierarchy(150), folder_ / "plant.glb");
  }
  void TearDown() override {
    if (mounted_) umount(disk_.c_str());
  }
  ProgramResult bake(const fs::path& output, const fs::path& cache) {
    return run_liana({"bake", "plant.glb", "--species", "apple", "-o", output, "--cache-dir", cache},
                     folder_.path());
  }
  size_t files() const {
    return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(disk_), {}));
  }

  ScratchFolder folder_;
  fs::path disk_ = folder_ / "disk";
  bool mounted_ = false;
};

TEST_F(FullDisk, LeavesNothingHalfWrittenAndTheOldBakeAsItWas) {
  write_file(disk_ / "old.bake", "old");
  for (const char* name : {"old.bake", "new.bake"}) {
    const ProgramResult result = bake(disk_ / name, folder_ / "cache");
    EXPECT_EQ(result.exit_code, 1) << result.out;
    EXPECT_THAT(result.err, HasSubstr(name));
    EXPECT_THAT(result.err, HasSubstr("has space"));
  }
  EXPECT_EQ(files(), 1u);
  EXPECT_EQ(read_file(disk_ / "old.bake"), "old");
}

TEST_F(FullDisk, CacheThatDoesNotFitIsANote) {
  const ProgramResult result = bake(folder_ / "plant.bake", disk_ / "cache");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("the cache was not kept"));
  EXPECT_EQ(files(), 1u);  // its empty folder
}

TEST_F(FullDisk, FailsOnlyThePlantsThatDoNotFit) {
  write_instanced_plant(make_branch_hierarchy(3), folder_ / "small.glb");
  write_file(folder_ / "plants.toml",
             "[defaults]\nspecies = \"apple\"\nfolder = \"disk\"\n[[plant]]\nfile = \"plant.glb\"\n"
             "[[plant]]\nfile = \"small.glb\"\n");
  const ProgramResult result =
      run_liana({"bake", "--manifest", "plants.toml", "--jobs", "1"}, folder_.path());
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 baked, 0 kept as they were, 1 failed"));
  EXPECT_EQ(files(), 1u);
  EXPECT_TRUE(fs::exists(disk_ / "small.bake"));
}

TEST(DevFull, OutputThereIsAnErrorAndTheDeviceStays) {
  ASSERT_TRUE(fs::is_character_file("/dev/full"));
  const ScratchFolder folder;
  write_instanced_plant(make_branch_hierarchy(3), folder / "plant.glb");
  for (const char* option : {"-o", "--report"}) {
    const ProgramResult result =
        run_liana({"bake", "plant.glb", "--species", "apple", option, "/dev/full"}, folder.path());
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("/dev/full"));
  }
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(DevFull, WordsThatCannotBePrintedAreAnError) {
  const ScratchFolder folder;
  const std::string command =
      "'" LIANA_PROGRAM "' inspect --species > /dev/full 2> '" + (folder / "err").string() + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(read_file(folder / "err"), HasSubstr("cannot be written"));
}

TEST(DevFull, VtuThatCannotBeWrittenLosesNoBake) {
  const ScratchFolder folder;
  write_instanced_plant(make_branch_hierarchy(3), folder / "plant.glb");
  const std::vector<std::string> bake = {"bake", "plant.glb", "--species", "apple",
                                         "-o",   "a.bake",    "--no-cache"};
  const auto with = [&](const std::string& vtu) {
    std::vector<std::string> all = bake;
    all.insert(all.end(), {"--vtu", vtu});
    return run_liana(all, folder.path());
  };
  const ProgramResult late = with("/dev/full");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_THAT(late.err, HasSubstr("has space"));
  EXPECT_TRUE(fs::exists(folder / "a.bake"));
  EXPECT_EQ(run_liana({"inspect", "a.bake"}, folder.path()).exit_code, 0);
  fs::remove(folder / "a.bake");
  const ProgramResult early = with("missing/a.vtu");
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.err, HasSubstr("missing"));
  EXPECT_FALSE(fs::exists(folder / "a.bake"));
}

}  // namespace
}  // namespace liana
