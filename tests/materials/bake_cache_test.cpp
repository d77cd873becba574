#include "materials/cache/bake_cache.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/bake/bake_file.h"
#include "materials/pipeline/bake_plant.h"
#include "mesher/base/files.h"
#include "tests/support/plants/large_plants.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

SpeciesLaw test_law() {
  SpeciesLaw law;
  law.species = "test";
  for (const char* group : {"level0", "level1", "leaf"}) law.groups[group] = GroupLaw{};
  law.groups["leaf"].epsilon2 = -0.1;
  return law;
}

class CachedBake : public testing::Test {
 protected:
  struct Outcome {
    Bake bake;
    size_t solved, misses;
    bool damaged;
  };

  /// As a user's command does: reads the cache's file, bakes, writes it.
  Outcome bake(const SegmentedPlant& plant, const SpeciesLaw& law, unsigned threads = 0) const {
    struct Counting : Progress {
      size_t solved = 0;
      void begin(std::string_view stage, size_t total) override {
        if (stage == "modes") solved += total;
      }
    } progress;
    BakeCache cache(file());
    BakeOptions options;
    options.threads = threads;
    options.cache = &cache;
    Outcome outcome{bake_plant(plant, law, options, progress).bake, progress.solved, cache.misses(),
                    cache.was_damaged()};
    cache.save();
    return outcome;
  }

  static Bake without_cache(const SegmentedPlant& plant, const SpeciesLaw& law) {
    Progress silent;
    return bake_plant(plant, law, {}, silent).bake;
  }

  fs::path file() const { return folder_ / "plant.cache"; }

  ScratchFolder folder_;
};

TEST_F(CachedBake, IsBitForBitTheBakeWithoutIt) {
  const SegmentedPlant plant = make_small_plant();
  const std::string expected = encode_bake(without_cache(plant, test_law()));
  const Outcome first = bake(plant, test_law());
  EXPECT_GT(first.solved, 0u);
  EXPECT_EQ(encode_bake(first.bake), expected);
  const Outcome again = bake(plant, test_law(), 1);
  EXPECT_EQ(again.solved, 0u);
  EXPECT_EQ(again.misses, 0u);
  EXPECT_EQ(encode_bake(again.bake), expected);
}

TEST_F(CachedBake, SolvesNothingWhenOnlyFrequenciesAndDampingChange) {
  const SegmentedPlant plant = make_small_plant();
  bake(plant, test_law());
  SpeciesLaw law = test_law();
  law.groups["level0"].reference_frequency = 1.7;
  law.groups["level1"].epsilon1 = -0.7;
  law.groups["leaf"].damping.high_factor = 0.2;
  const Outcome tuned = bake(plant, law);
  EXPECT_EQ(tuned.solved, 0u);
  EXPECT_EQ(encode_bake(tuned.bake), encode_bake(without_cache(plant, law)));
}

// Other masses of leaves change what branches carry, not the leaves; the trunk, three branches and three
// twigs carry something.
TEST_F(CachedBake, SolvesOnlyWhatCarriesOtherMasses) {
  const SegmentedPlant plant = make_small_plant();
  bake(plant, test_law());
  SpeciesLaw law = test_law();
  law.groups["leaf"].c2 = 1.5;
  const Outcome heavier = bake(plant, law);
  EXPECT_GT(heavier.solved, 0u);
  EXPECT_LE(heavier.solved, 7u);
  EXPECT_EQ(encode_bake(heavier.bake), encode_bake(without_cache(plant, law)));
}

// ν goes with √(E/ρ): a product and a root, each rounded once, on frequencies that are rounded themselves.
TEST_F(CachedBake, ScalesFrequenciesWithTheDefaultMaterial) {
  const SegmentedPlant plant = make_small_plant();
  bake(plant, test_law());
  SpeciesLaw law = test_law();
  law.default_material.youngs_modulus *= 1.7;
  law.default_material.density *= 0.6;
  const Outcome other = bake(plant, law);
  EXPECT_EQ(other.solved, 0u);
  const Bake expected = without_cache(plant, law);
  ASSERT_EQ(other.bake.domains.size(), expected.domains.size());
  for (size_t i = 0; i < expected.domains.size(); ++i)
    EXPECT_NEAR(other.bake.domains[i].default_frequency / expected.domains[i].default_frequency, 1, 1e-11);
}

TEST_F(CachedBake, SolvesAgainForAnotherPoissonRatio) {
  const SegmentedPlant plant = make_small_plant();
  bake(plant, test_law());
  SpeciesLaw law = test_law();
  law.default_material.poisson_ratio = 0.2;
  const Outcome other = bake(plant, law);
  EXPECT_GT(other.solved, 0u);
  EXPECT_EQ(encode_bake(other.bake), encode_bake(without_cache(plant, law)));
}

// A branch that is edited is made anew, with what hangs on it and what it hangs on; other branches stay.
TEST_F(CachedBake, KeepsWhatAnEditDoesNotTouch) {
  SegmentedPlant plant = flatten(make_branch_hierarchy(13));
  const SpeciesLaw law = test_law();
  const size_t all = bake(plant, law).solved;
  ASSERT_EQ(all, 13u);
  for (Vec3& p : plant.domains[12].surface.positions) p += Vec3(0, 1e-3, 0);
  const Outcome edited = bake(plant, law);
  EXPECT_LE(edited.solved, 3u);  // itself, what carries it, and the trunk
  EXPECT_EQ(encode_bake(edited.bake), encode_bake(without_cache(plant, law)));
}

TEST_F(CachedBake, DamagedFilesCountAsEmptyAndAreMadeAnew) {
  const SegmentedPlant plant = make_small_plant();
  bake(plant, test_law());
  const std::string whole = read_file(file());
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  const std::string expected = encode_bake(without_cache(plant, test_law()));
  for (const std::string& bytes : {flipped, whole.substr(0, whole.size() / 2), whole.substr(0, 5),
                                   std::string("something else"), whole + "x"}) {
    write_file(file(), bytes);
    const Outcome outcome = bake(plant, test_law());
    EXPECT_TRUE(outcome.damaged) << bytes.size();
    EXPECT_GT(outcome.solved, 0u);
    EXPECT_EQ(encode_bake(outcome.bake), expected);
    EXPECT_EQ(bake(plant, test_law()).solved, 0u);
  }
}

TEST_F(CachedBake, PlantWithPartsThatCannotBeMadeSolidIsTheSame) {
  SegmentedPlant plant = make_small_plant();
  plant.domains[3].surface = {{Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  const std::string expected = encode_bake(without_cache(plant, test_law()));
  for (int round = 0; round < 2; ++round) EXPECT_EQ(encode_bake(bake(plant, test_law()).bake), expected);
}

TEST(BakeCache, KeepsWhatWasFoundAndAsMuchOfTheRest) {
  const ScratchFolder folder;
  const fs::path file = folder / "a" / "b.cache";
  const std::string thousand(1000, 'x');
  {
    BakeCache cache(file);
    for (uint64_t key = 1; key <= 10; ++key) cache.put(key, thousand);
    cache.save();
  }
  {
    BakeCache cache(file);
    EXPECT_EQ(cache.find(7).value(), thousand);
    EXPECT_FALSE(cache.find(11));
    cache.put(12, thousand);
    cache.save();
  }
  BakeCache cache(file);
  EXPECT_TRUE(cache.find(7));
  EXPECT_TRUE(cache.find(12));
  size_t others = 0;
  for (uint64_t key = 1; key <= 10; ++key) others += key != 7 && cache.find(key);
  EXPECT_GE(others, 1u);
  EXPECT_LE(others, 2u);
}

TEST(BakeCache, FileIsNamedAfterThePlantsPath) {
  EXPECT_NE(cache_file("c", "a/tree.glb"), cache_file("c", "b/tree.glb"));
  EXPECT_EQ(cache_file("c", "a/tree.glb"), cache_file("c", "a/../a/tree.glb"));
}

}  // namespace
}  // namespace liana
