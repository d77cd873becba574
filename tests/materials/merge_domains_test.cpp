// Coarse against fine decompositions: [Wang17] §7, Figure 18.
#include "mesher/solids/unions/merge_domains.h"

#include <gtest/gtest.h>

#include "materials/pipeline/bake_plant.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

Bake bake(const SegmentedPlant& plant) {
  SpeciesLaw law;
  law.species = "test";
  law.groups = {{"level0", {}}, {"level1", {}}, {"leaf", {}}};
  Progress silent;
  return bake_plant(plant, law, {}, silent).bake;
}

MergedPlant merged(const SegmentedPlant& plant, int level) {
  Progress silent;
  return merge_below(plant, level, 1, silent);
}

TEST(MergeBelow, MakesABranchAndItsTwigsOneAndKeepsLeaves) {
  const SegmentedPlant fine = make_small_plant();
  const MergedPlant coarse = merged(fine, 1);
  EXPECT_EQ(coarse.plant.domains.size(), fine.domains.size() - 3);  // three twigs
  for (size_t i = 0; i < fine.domains.size(); ++i) {
    const Domain& before = fine.domains[i];
    const Domain& now = coarse.plant.domains[coarse.became[i].index()];
    if (before.kind == DomainKind::Branch && before.level == 2) {
      EXPECT_EQ(now.name, fine.domains[before.parent.index()].name);
      continue;
    }
    EXPECT_EQ(now.name, before.name);
    if (before.parent.valid()) {
      EXPECT_EQ(now.parent, coarse.became[before.parent.index()]);
    }
  }
  EXPECT_NE(coarse.plant.notes.at(0).find("3 branches became part of another"), std::string::npos)
      << coarse.plant.notes[0];
  EXPECT_EQ(coarse.plant.notes.size(), 1u);
}

// Figure 18: in the coarse decomposition small branches share the material of what they grow on, and lose the
// lively motion of their own; the whole branch, longer with its twigs, swings no faster than before.
TEST(MergeBelow, SmallBranchesLoseTheirFasterMotion) {
  const SegmentedPlant fine_plant = make_small_plant();
  const MergedPlant merging = merged(fine_plant, 1);
  const Bake fine = bake(fine_plant), coarse = bake(merging.plant);
  ASSERT_TRUE(coarse.failed.empty()) << coarse.failed[0];
  ASSERT_EQ(fine.domains.size(), fine_plant.domains.size());
  int twigs = 0;
  for (size_t i = 0; i < fine.domains.size(); ++i) {
    const BakedDomain &before = fine.domains[i], &now = coarse.domains[merging.became[i].index()];
    SCOPED_TRACE(before.name);
    if (before.kind == DomainKind::Branch && before.level == 2) {
      ++twigs;
      EXPECT_LT(now.material.frequency, before.material.frequency);
    } else if (before.kind == DomainKind::Branch && before.level == 1) {
      EXPECT_GE(now.length, before.length * (1 - 1e-9));
      EXPECT_LE(now.material.frequency, before.material.frequency * (1 + 1e-9));
      EXPECT_GT(now.mass, before.mass);
    } else if (before.level ==
               0) {  // what it carries is the same but for what the twigs shared with their branch
      EXPECT_NEAR(now.default_frequency / before.default_frequency, 1, 0.02);
    }
  }
  EXPECT_EQ(twigs, 3);
}

TEST(MergeBelow, LeavesApartWhatDoesNotTouchAndSaysSo) {
  SegmentedPlant plant = make_small_plant();
  size_t twig = 0;
  while (plant.domains[twig].level != 2) ++twig;
  for (Vec3& p : plant.domains[twig].surface.positions) p += Vec3(0, 5, 0);
  const MergedPlant coarse = merged(plant, 1);
  EXPECT_EQ(coarse.plant.domains.size(), plant.domains.size() - 2);
  EXPECT_EQ(coarse.plant.domains[coarse.became[twig].index()].name, plant.domains[twig].name);
  ASSERT_EQ(coarse.plant.notes.size(), 2u);
  EXPECT_NE(coarse.plant.notes[1].find(plant.domains[twig].name), std::string::npos);
}

TEST(MergeBelow, TheDeepestLevelChangesNothing) {
  const SegmentedPlant plant = make_small_plant();
  const MergedPlant same = merged(plant, 9);
  ASSERT_EQ(same.plant.domains.size(), plant.domains.size());
  for (size_t i = 0; i < plant.domains.size(); ++i) EXPECT_EQ(same.became[i], DomainId(i));
}

}  // namespace
}  // namespace liana
