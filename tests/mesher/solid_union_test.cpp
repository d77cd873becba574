#include "mesher/surface/solid_union.h"

#include <gtest/gtest.h>

#include "mesher/base/mesh_checks.h"
#include "mesher/surface/self_intersection.h"
#include "tests/support/shapes.h"

namespace liana {
namespace {

// Two bars of 1 × 0.2 × 0.2 that cross in a cube of 0.2: 2 · 0.04 - 0.008. The numbers are exact but for the
// rounding of coordinates, some 1e-16 of 1.
TEST(SolidUnion, OfCrossingBarsHasTheVolumeOfBothLessWhatTheyShare) {
  SolidUnion both(make_box(Vec3(-0.5, -0.1, -0.1), Vec3(1, 0.2, 0.2)));
  ASSERT_TRUE(both.add(make_box(Vec3(-0.1, -0.5, -0.1), Vec3(0.2, 1, 0.2))));
  const Mesh mesh = both.mesh(1e-6);
  EXPECT_NEAR(signed_volume(mesh), 0.072, 1e-12);
  EXPECT_TRUE(find_adjacency(mesh).closed);
  EXPECT_TRUE(find_adjacency(mesh).oriented);
}

// The twig (0.5 m) leaves a branch of 0.05 m radius at a slant, from 0.014 m beside its axis: between 0.03
// and 0.08 m of it are inside.
TEST(SolidUnion, AddsATwigAsFarAsItStandsOut) {
  const MarkedMesh branch = make_prism(12, 1, 0.1), twig = make_prism(12, 0.5, 0.03);
  const Affine3 place =
      Eigen::Translation3d(0.0123, 0.61, 0.0071) * Eigen::AngleAxisd(1.3, Vec3(0.2, 0.1, 1).normalized());
  SolidUnion both(branch.mesh);
  ASSERT_TRUE(both.add(transformed(twig.mesh, place)));
  const Mesh mesh = both.mesh(1e-5);
  const double added = signed_volume(mesh) - signed_volume(branch.mesh), whole = signed_volume(twig.mesh);
  EXPECT_LT(added, whole * (0.5 - 0.03) / 0.5);
  EXPECT_GT(added, whole * (0.5 - 0.08) / 0.5);
  EXPECT_FALSE(self_intersects(mesh));
}

TEST(SolidUnion, RefusesWhatDoesNotTouchAndStaysAsItWas) {
  const Mesh box = make_box(Vec3::Zero(), Vec3(1, 1, 1));
  SolidUnion both(box);
  EXPECT_FALSE(both.add(make_box(Vec3(2, 0, 0), Vec3(1, 1, 1))));
  EXPECT_NEAR(signed_volume(both.mesh(0)), 1, 1e-12);
  EXPECT_TRUE(both.add(make_box(Vec3(0.5, 0.1, 0.1), Vec3(1, 0.5, 0.5))));
}

}  // namespace
}  // namespace liana
