#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "materials/bake/bake_check.h"
#include "materials/bake/bake_file.h"
#include "materials/law/material_model.h"
#include "materials/law/power_law.h"
#include "materials/pipeline/bake_plant.h"
#include "materials/pipeline/baked_solids.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "tests/support/solids/damage.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

/// A law with C₂, ε₂ and damping that differ between groups, so that nothing cancels by accident.
SpeciesLaw test_law() {
  SpeciesLaw law;
  law.species = "test";
  const auto group = [](double frequency, double c2, double epsilon2) {
    GroupLaw group;
    group.reference_frequency = frequency;
    group.c2 = c2;
    group.epsilon2 = epsilon2;
    return group;
  };
  law.groups = {
      {"level0", group(1.5, 2, 0.5)}, {"level1", group(2, 1.3, 0)}, {"leaf", group(1.2, 0.9, -0.1)}};
  return law;
}

BakeResult bake(const SegmentedPlant& plant, const BakeOptions& options = {}) {
  Progress silent;
  return bake_plant(plant, test_law(), options, silent);
}

SegmentedPlant plant_of(const Mesh& surface) {
  SegmentedPlant plant;
  plant.name = "one";
  plant.domains.emplace_back();
  plant.domains[0].name = "trunk";
  plant.domains[0].group = "level0";
  plant.domains[0].surface = surface;
  return plant;
}

/// A surface without area cannot be made solid.
Mesh collapsed() {
  return {{Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
}

size_t index_of(const std::vector<Domain>& domains, DomainKind kind, int level) {
  for (size_t i = 0; i < domains.size(); ++i)
    if (domains[i].kind == kind && domains[i].level == level) return i;
  ADD_FAILURE() << "no such domain";
  return 0;
}

TEST(BakePlant, BakesEveryDomainByItsLaw) {
  const SegmentedPlant plant = make_small_plant();
  const BakeResult result = bake(plant);
  ASSERT_TRUE(result.bake.failed.empty()) << result.bake.failed.front();
  ASSERT_EQ(result.bake.domains.size(), plant.domains.size());
  EXPECT_NO_THROW(check(result.bake, "bake"));
  const SpeciesLaw law = test_law();
  for (size_t i = 0; i < plant.domains.size(); ++i) {
    const BakedDomain& domain = result.bake.domains[i];
    SCOPED_TRACE(domain.name);
    EXPECT_EQ(domain.name, plant.domains[i].name);
    EXPECT_EQ(domain.parent, plant.domains[i].parent);
    const DomainMaterial expected = evaluate(law.group(domain.group), domain.length);
    EXPECT_EQ(domain.material.frequency, expected.frequency);
    EXPECT_EQ(domain.material.damping_factor, expected.damping_factor);
    EXPECT_DOUBLE_EQ(domain.stiffness_scaling,
                     expected.mass_scaling * std::pow(expected.frequency / domain.default_frequency, 2));
    EXPECT_DOUBLE_EQ(domain.youngs_modulus, domain.stiffness_scaling * law.default_material.youngs_modulus);
    EXPECT_DOUBLE_EQ(domain.density, domain.material.mass_scaling * law.default_material.density);
    EXPECT_GE(domain.stiffness_ratio, 1 - 1e-9);
  }
}

// [Wang17] Eq. 10 and 11: ν_default is that of the tapered domain, and with the bake's E and ρ as they vary
// along it it swings at the law's frequency. Scaling K and M by constants is exact but for rounding: 1e-9.
TEST(BakePlant, TaperedMaterialSwingsAtTheLawsFrequencyAfterReading) {
  const SegmentedPlant plant = plant_of(make_prism(6, 1, 0.05).mesh);
  SpeciesLaw law = test_law();
  law.groups["level0"].taper = {1.2, 0.2, 2};
  Progress silent;
  const Bake baked = bake_plant(plant, law, {}, silent).bake;
  const Bake read = decode_bake(encode_bake(baked), "taper.bake");
  ASSERT_EQ(read.domains.size(), 1u);
  const BakedDomain& domain = read.domains[0];
  EXPECT_EQ(read.law.group(domain.group).taper, law.groups["level0"].taper);
  EXPECT_GT(std::abs(domain.default_frequency / bake(plant).bake.domains[0].default_frequency - 1), 0.05);
  EXPECT_DOUBLE_EQ(
      domain.stiffness_scaling,
      domain.material.mass_scaling * std::pow(domain.material.frequency / domain.default_frequency, 2));

  const std::vector<UnitedPart> parts = baked_solids(plant, read);
  ASSERT_EQ(parts[0].scaling.size(), parts[0].mesh.tets.size());
  const Modes modes = lowest_modes(parts[0].mesh, parts[0].material, {}, {}, parts[0].scaling);
  EXPECT_NEAR(modes.frequencies[0] / domain.material.frequency, 1, 1e-9);
}

// The definition of the scaled material: with E and ρ of the bake and the true masses of all descendants on
// it, a domain swings at the law's frequency. Scaling K and M by constants is exact but for rounding, hence
// 1e-9; a domain that took the modes of an equal shape is within what the search for equal shapes allows, 0.2
// %, or 0.3 % to be on the safe side.
TEST(BakePlant, ScaledMaterialSwingsAtTheLawsFrequency) {
  const SegmentedPlant plant = make_small_plant();
  const Bake bake = liana::bake(plant).bake;
  ASSERT_EQ(bake.domains.size(), plant.domains.size());
  std::vector<double> subtree(bake.domains.size());
  for (size_t i = bake.domains.size(); i-- > 0;) {
    subtree[i] += bake.domains[i].mass;
    if (bake.domains[i].parent.valid()) subtree[bake.domains[i].parent.index()] += subtree[i];
  }
  size_t solved_alone = 0;
  for (size_t i = 0; i < bake.domains.size(); ++i) {
    const BakedDomain& domain = bake.domains[i];
    SCOPED_TRACE(domain.name);
    std::vector<CarriedMass> carried;
    for (size_t child = i + 1; child < bake.domains.size(); ++child)
      if (bake.domains[child].parent == DomainId(i))
        carried.push_back({make_solid(plant, DomainId(child)).root, subtree[child]});
    const SolidDomain solid = make_solid(plant, DomainId(i));
    const ElasticMaterial material{domain.youngs_modulus, domain.density,
                                   bake.law.default_material.poisson_ratio};
    const Modes modes = lowest_modes(tetrahedralize(solid.surface, solid.is_root), material, carried);
    const bool alone = domain.solved_as == DomainId(i);
    solved_alone += alone;
    EXPECT_NEAR(modes.frequencies[0] / domain.material.frequency, 1, alone ? 1e-9 : 3e-3);
  }
  EXPECT_GE(solved_alone, 3u);
}

// [Wang17] §4.1: ℓ = 5 m, d = 0.4 m, apple wood: 7.7 Hz by Eq. 5. A 24-gon in the circle has √((2 + cos
// 15°)/3) of a round rod's frequency; shear and the clamp's Poisson restraint shift AR 12.5 by less than 2 %.
TEST(BakePlant, BareAppleTrunkSwingsAtThePapersFrequency) {
  const double round = 1.8751 * 1.8751 / (8 * kPi) * 0.4 / 25 * std::sqrt(8.77e9 / 745);
  EXPECT_NEAR(round, 7.7, 0.05);
  const BakeResult result = bake(plant_of(make_prism(24, 5, 0.4).mesh));
  const BakedDomain& trunk = result.bake.domains.at(0);
  EXPECT_NEAR(trunk.length, 5, 0.05 * 5);
  EXPECT_NEAR(trunk.default_frequency, round * std::sqrt((2 + std::cos(2 * kPi / 24)) / 3), 0.02 * round);
  EXPECT_NEAR(trunk.stiffness_ratio, 1, 0.02);
  EXPECT_FALSE(trunk.parent.valid());
}

// A flat strip 4 cm wide and 0.3 mm thick, held along its whole width, bends far more easily across its
// blade: the ratio of second moments is (40/0.3)², and sways include shear, which takes part of it back.
TEST(BakePlant, FlatLeafIsSoftAcrossItsBlade) {
  SegmentedPlant plant = plant_of(make_prism(8, 0.5, 0.02).mesh);
  Domain leaf;
  leaf.name = leaf.group = "leaf";
  leaf.kind = DomainKind::Leaf;
  leaf.parent = DomainId(size_t{0});
  leaf.level = 1;
  leaf.surface =
      transformed(make_leaf_card({.length = 0.1, .width = 0.04, .bend = 0, .fold = 0, .pointed = false}),
                  Affine3(Eigen::Translation3d(0, 0.5, 0)));
  plant.domains.push_back(leaf);
  const Bake bake = liana::bake(plant).bake;
  ASSERT_EQ(bake.domains.size(), 2u) << bake.failed.at(0);
  const BakedDomain& blade = bake.domains[1];
  EXPECT_GT(blade.stiffness_ratio, 100);
  EXPECT_NEAR(std::abs(blade.flat_normal.z()), 1, 0.01);
  for (const Station& station : blade.centreline) {
    EXPECT_LT(station.half_thickness, 1e-3);
    EXPECT_GT(station.half_width, 5e-3);
  }
}

TEST(BakePlant, DoesNotDependOnTheNumberOfThreads) {
  const SegmentedPlant plant = make_small_plant();
  BakeOptions one, two;
  one.threads = 1, two.threads = 2;
  EXPECT_EQ(encode_bake(bake(plant, one).bake), encode_bake(bake(plant, two).bake));
}

TEST(BakePlant, LeavesOutWhatCannotBeMadeSolidAndSaysSo) {
  SegmentedPlant plant = make_small_plant();
  const size_t twig = index_of(plant.domains, DomainKind::Branch, 2);
  plant.domains[twig].surface = collapsed();
  const Bake bake = liana::bake(plant).bake;
  ASSERT_EQ(bake.failed.size(), 1u);
  EXPECT_NE(bake.failed[0].find(plant.domains[twig].name), std::string::npos) << bake.failed[0];
  const std::string grandparent = plant.domains[plant.domains[twig].parent.index()].name;
  EXPECT_NE(bake.failed[0].find("attaches to '" + grandparent + "'"), std::string::npos) << bake.failed[0];
  ASSERT_EQ(bake.domains.size(), plant.domains.size() - 1);
  EXPECT_NO_THROW(check(bake, "bake"));
  for (const Domain& leaf : plant.domains) {
    if (leaf.parent != DomainId(twig)) continue;
    for (const BakedDomain& domain : bake.domains) {
      if (domain.name != leaf.name) continue;
      EXPECT_EQ(bake.domains[domain.parent.index()].name, grandparent);
    }
  }
}

TEST(BakePlant, StrictStopsAtWhatCannotBeMadeSolid) {
  SegmentedPlant plant = make_small_plant();
  plant.domains.back().surface = collapsed();
  BakeOptions strict;
  strict.strict = true;
  try {
    bake(plant, strict);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Input);
    EXPECT_NE(std::string(error.what()).find(plant.domains.back().name), std::string::npos);
    EXPECT_NE(error.hint.find("--strict"), std::string::npos);
  }
}

TEST(BakePlant, PlantWithoutAnySolidDomainIsAnError) {
  EXPECT_THROW(bake(plant_of(collapsed())), Error);
  EXPECT_THROW(bake(SegmentedPlant{}), Error);
}

TEST(BakePlant, GroupWithoutLawIsRefusedBeforeAnyWork) {
  SegmentedPlant plant = make_small_plant();
  plant.domains.back().group = "fruit";
  struct Counting : Progress {
    int stages = 0;
    void begin(std::string_view, size_t) override { ++stages; }
  } progress;
  EXPECT_THROW(bake_plant(plant, test_law(), {}, progress), Error);
  EXPECT_EQ(progress.stages, 0);
}

TEST(BakePlant, StopsWhenCancelledAtAnyMoment) {
  const SegmentedPlant plant = make_small_plant();
  for (int after : {0, 3, 14}) {  // 13 domains: before, in the first stage, in the second
    struct Impatient : Progress {
      std::atomic<int> left;
      explicit Impatient(int after) : left(after) {}
      void advance(size_t) override { --left; }
      bool cancelled() const override { return left <= 0; }
    } progress(after);
    try {
      bake_plant(plant, test_law(), {}, progress);
      ADD_FAILURE() << after;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Cancelled) << error.what();
    }
  }
}

TEST(BakePlant, NotesGroupsThatBorrowALaw) {
  const BakeResult result = bake(make_small_plant());  // its twigs are of level2, which the law lacks
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_NE(result.notes[0].find("level2"), std::string::npos);
}

TEST(BakePlant, NotesWhatMendingCost) {
  SegmentedPlant plant = plant_of(make_prism(6, 1, 0.1).mesh);
  EXPECT_TRUE(bake(plant).notes.empty());
  add_fin(plant.domains[0].surface, 0, 0.02);
  const BakeResult result = bake(plant);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_TRUE(result.notes[0].starts_with("1 domain lost something when mended: 'trunk'")) << result.notes[0];
}

// The models differ in ν alone; what Eq. 10 and 15 make of it is the same.
TEST(BakePlant, BakesByOtherModelsToo) {
  const SegmentedPlant plant = make_small_plant();
  const Bake power = bake(plant).bake;
  for (const MaterialModel model : {MaterialModel::Constant, MaterialModel::Depth, MaterialModel::Median}) {
    SCOPED_TRACE(model_name(model));
    SpeciesLaw law = test_law();
    law.model.model = model;
    Progress silent;
    const BakeResult result = bake_plant(plant, law, {}, silent);
    ASSERT_EQ(result.bake.domains.size(), power.domains.size());
    EXPECT_EQ(decode_bake(encode_bake(result.bake), "bake").law.model.model, model);
    std::vector<ModelledDomain> domains;
    for (const BakedDomain& d : result.bake.domains)
      domains.push_back({d.group, d.kind, d.level, d.length, d.default_frequency});
    const std::vector<double> expected = model_frequencies(law, domains).frequencies;
    for (size_t i = 0; i < domains.size(); ++i) {
      const BakedDomain& domain = result.bake.domains[i];
      EXPECT_EQ(domain.default_frequency, power.domains[i].default_frequency);
      EXPECT_EQ(domain.material.frequency, expected[i]);
      EXPECT_EQ(domain.mass, power.domains[i].mass);
      EXPECT_DOUBLE_EQ(domain.stiffness_scaling,
                       domain.material.mass_scaling * std::pow(expected[i] / domain.default_frequency, 2));
    }
  }
}

TEST(BakePlant, GroupsOfTheSpeciesClaimDomainsByName) {
  SegmentedPlant plant = make_small_plant();
  const size_t twig = index_of(plant.domains, DomainKind::Branch, 2);
  plant.domains[twig].name = "P1";
  SpeciesLaw law = test_law();
  law.groups["tracked"] = law.groups["level1"];
  law.groups["tracked"].reference_frequency = 3.18;
  law.groups["tracked"].match.name = "P[0-9]";
  Progress silent;
  const Bake bake = bake_plant(plant, law, {}, silent).bake;
  EXPECT_EQ(bake.domains[twig].group, "tracked");
  EXPECT_EQ(bake.domains[twig].material.frequency,
            frequency_of_length(law.groups["tracked"], bake.domains[twig].length));
  EXPECT_EQ(std::count_if(bake.domains.begin(), bake.domains.end(),
                          [](const BakedDomain& domain) { return domain.group == "tracked"; }),
            1);
}

}  // namespace
}  // namespace liana
