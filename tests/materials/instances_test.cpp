#include "materials/cache/instances.h"

#include <gtest/gtest.h>

#include "tests/support/plants/large_plants.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

TEST(Instances, LeafletsOfAPalmAreAllOneShape) {
  const SegmentedPlant palm = flatten(make_palm(5, 60));
  const std::vector<Instance> instances = find_instances(palm);
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(instances[i].source, i);
  for (size_t i = 6; i < instances.size(); ++i) {
    EXPECT_EQ(instances[i].source, 6u);
    EXPECT_NEAR(instances[i].similarity.scale * palm.domains[6].thickness, palm.domains[i].thickness, 1e-12);
  }
}

TEST(Instances, BranchesOfDifferentProportionsAreNot) {
  const std::vector<Instance> instances = find_instances(flatten(make_branch_hierarchy(300)));
  for (size_t i = 0; i < instances.size(); ++i) EXPECT_EQ(instances[i].source, i);
}

TEST(Instances, SheetScaledWithoutItsThicknessIsNoCopy) {
  SegmentedPlant palm = flatten(make_palm(1, 2));
  palm.domains[3].thickness *= 1.01;
  EXPECT_EQ(find_instances(palm)[3].source, 3u);
}

TEST(Instances, MirrorImageIsNoCopy) {
  SegmentedPlant palm = flatten(make_palm(1, 2));
  palm.domains[3].surface = transformed(palm.domains[2].surface, Affine3(Eigen::Scaling(-1., 1., 1.)));
  palm.domains[3].thickness = palm.domains[2].thickness;
  EXPECT_EQ(find_instances(palm)[3].source, 3u);
}

// The same tube hanging on its parent by its base and by its tip.
TEST(Instances, AttachedByTheOtherEndIsNotAttachedAlike) {
  SegmentedPlant plant = make_small_plant();
  const size_t twig = 2;
  ASSERT_EQ(plant.domains[twig].level, 2);
  const SolidDomain solid = make_solid(plant, DomainId(twig));
  EXPECT_TRUE(attached_alike(plant, DomainId(twig), solid, DomainId(twig), {}));
  Domain turned = plant.domains[twig];
  const Vec3 tip = solid.centreline.back().centre;
  Similarity half_turn;  // about an axis through its middle
  half_turn.rotation = Eigen::AngleAxisd(kPi, (tip - solid.root).unitOrthogonal()).toRotationMatrix();
  half_turn.translation = solid.root - half_turn.rotation * tip;
  for (Vec3& p : turned.surface.positions) p = half_turn.point(p);
  plant.domains.push_back(turned);
  EXPECT_FALSE(attached_alike(plant, DomainId(twig), solid, DomainId(plant.domains.size() - 1), half_turn));
}

// Solids of copies come from their source: all numbers as if made on their own, to rounding.
TEST(Instances, MovedSolidIsTheCopysOwn) {
  const SegmentedPlant palm = flatten(make_palm(3, 30));
  const std::vector<Instance> instances = find_instances(palm);
  const SolidDomain source = make_solid(palm, DomainId(size_t{4}));
  for (const size_t i : {5u, 12u, 33u}) {
    ASSERT_EQ(instances[i].source, 4u);
    const SolidDomain own = make_solid(palm, DomainId(i));
    const SolidDomain copy = moved(source, instances[i].similarity);
    EXPECT_NEAR(copy.length / own.length, 1, 1e-6);
    EXPECT_NEAR(copy.volume / own.volume, 1, 1e-6);
    EXPECT_LT((copy.root - own.root).norm(), 1e-6);
    ASSERT_EQ(copy.centreline.size(), own.centreline.size());
    EXPECT_LT((copy.centreline.back().centre - own.centreline.back().centre).norm(), 1e-6);
    EXPECT_NEAR(copy.centreline[1].half_width / own.centreline[1].half_width, 1, 1e-6);
  }
}

}  // namespace
}  // namespace liana
