// Plants of all formats through the program, as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesher/base/files.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/hierarchy_score.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

using testing::HasSubstr;

TEST(AnyPlant, AMergedObjInCentimetresBakesAsTheSegmentedPlantDoes) {
  const ScratchFolder folder;
  write_file(folder / "tree.obj", merged_obj(make_small_plant(), true, 100));
  const ProgramResult seen = run_liana({"inspect", "tree.obj"}, folder.path());
  EXPECT_EQ(seen.exit_code, 0) << seen.err;
  for (const char* part : {"13 domains", "13 shells found", "7 branches, 6 leaves",
                           "unit guessed: centimetres", "1 trunk; no parent is doubtful"})
    EXPECT_THAT(seen.out, HasSubstr(part));
  const ProgramResult baked =
      run_liana({"bake", "tree.obj", "--species", "apple", "--unit", "cm"}, folder.path());
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, HasSubstr("13 domains"));
  EXPECT_TRUE(std::filesystem::exists(folder / "tree.bake"));
}

TEST(AnyPlant, ASkeletonBakes) {
  const ScratchFolder folder;
  write_file(
      folder / "stem.json",
      R"({"liana_graph": 1, "nodes": [{"position": [0,0,0], "radius": 0.03}, {"parent": 0, "position": [0,1,0], "radius": 0.02},
                 {"parent": 1, "position": [0,2,0]}, {"parent": 1, "position": [0.4,1.2,0], "begins_axis": true}]})");
  const ProgramResult baked = run_liana({"bake", "stem.json", "--species", "walnut"}, folder.path());
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, HasSubstr("2 of 4 diameters are missing"));
}

TEST(AnyPlant, ASkeletonWithoutDiametersSaysWhatIsTaken) {
  const ScratchFolder folder;
  write_file(folder / "stem.json",
             R"({"liana_graph": 1, "nodes": [{"position": [0,0,0]}, {"parent": 0, "position": [0,0.2,0]}]})");
  const ProgramResult baked = run_liana({"bake", "stem.json", "--species", "walnut"}, folder.path());
  EXPECT_EQ(baked.exit_code, 0) << baked.err;
  EXPECT_THAT(baked.out, HasSubstr("no diameter is given: tips are taken to be 3 mm thick"));
}

TEST(AnyPlant, BadFilesAreOneMessageWithThePlace) {
  const ScratchFolder folder;
  write_file(folder / "a.obj", "v 0 0 0\nf 1 2 3\n");
  write_file(folder / "a.ply", "ply\nformat ascii 2.0 x\nelement vertex 1\nend_header\n");
  write_file(folder / "a.mtg", "MTG :\nENTITY-CODE\tL\n");
  write_file(folder / "a.json", R"({"liana_graph": 1, "nodes": []})");
  for (const auto& [file, part] : {std::pair("a.obj", "a.obj:2: a face names vertex 3"),
                                   {"a.ply", "a.ply: its vertices have no x, y and z"},
                                   {"a.mtg", "a.mtg:2: the table has no columns"},
                                   {"a.json", "a.json: has 0 nodes"}}) {
    const ProgramResult result = run_liana({"bake", file, "--species", "apple"}, folder.path());
    EXPECT_EQ(result.exit_code, 1) << file;
    EXPECT_THAT(result.err, HasSubstr(part));
  }
}

}  // namespace
}  // namespace liana
