#include "mesher/exact/solid_union.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "mesher/base/progress.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/io/plant_file.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "mesher/solids/unions/merge_domains.h"
#include "mesher/tets/tetrahedralize.h"
#include "tests/support/solids/shapes.h"

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

// CGAL leaves choices between equals to the addresses of what it allocates.
TEST(SolidUnion, IsTheSameWhateverElseIsOnTheHeap) {
  const auto fence = [] {
    SolidUnion all(make_box(Vec3(-0.01, 0.2, 0), Vec3(0.8, 0.05, 0.02)));
    for (int i = 0; i < 8; ++i) {
      const double x = 0.1 * i;
      EXPECT_TRUE(all.add(make_box(Vec3(x, 0, 0), Vec3(0.02, 1, 0.02))));
      EXPECT_TRUE(all.add(make_box(Vec3(x, 0.45, -0.05), Vec3(0.12, 0.05, 0.2))));
    }
    return all.mesh(1e-5);
  };
  const Mesh first = fence();
  std::vector<std::unique_ptr<char[]>> clutter;
  for (size_t i = 0; i < 20000; ++i) {
    clutter.push_back(std::make_unique<char[]>(16 + i * 7919 % 5000));
    if (i % 3 == 0) clutter[i / 2].reset();
  }
  const Mesh second = fence();
  ASSERT_EQ(first.triangles, second.triangles);
  for (size_t i = 0; i < first.positions.size(); ++i) EXPECT_TRUE(first.positions[i] == second.positions[i]);
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

/// m: the smallest height of a triangle.
double least_height(const Mesh& mesh) {
  double least = 1e9;
  for (const Triangle& t : mesh.triangles) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm());
    least = std::min(least, 2 * area_vector(mesh, t).norm() / longest);
  }
  return least;
}

// Twigs whose rings all but meet the branch's edges: exact unions of them have triangles of any thinness,
// which tetrahedra do not survive.
TEST(SolidUnion, HasNoThinTrianglesThoughSurfacesAllButMeet) {
  for (int i = 0; i < 12; ++i) {
    const double off = std::pow(10., -3 - i % 6), turn = 0.1 * i;
    SolidUnion all(make_prism(12, 1, 0.1).mesh);
    for (int twig = 0; twig < 3; ++twig) {
      const Affine3 place = Eigen::Translation3d(0, 0.3 + 0.2 * twig + off, 0) *
                            Eigen::AngleAxisd(twig + off, Vec3::UnitY()) *
                            Eigen::AngleAxisd(kPi / 2 - turn / 3, Vec3::UnitZ());
      ASSERT_TRUE(all.add(transformed(make_prism(12, 0.4, 0.05).mesh, place)));
    }
    const double least = 3e-4, exact = signed_volume(all.mesh(0));
    const Mesh mesh = all.mesh(least);
    EXPECT_FALSE(self_intersects(mesh)) << i;
    EXPECT_GT(least_height(mesh), 0.05 * least) << i;
    // What moves does so by `least`, near the cuts only: far below least × area, 0.1 % of the volume.
    EXPECT_NEAR(signed_volume(mesh) / exact, 1, 1e-3) << i;
  }
}

TEST(SolidUnion, RefusesWhatDoesNotTouchAndStaysAsItWas) {
  const Mesh box = make_box(Vec3::Zero(), Vec3(1, 1, 1));
  SolidUnion both(box);
  EXPECT_FALSE(both.add(make_box(Vec3(2, 0, 0), Vec3(1, 1, 1))));
  EXPECT_NEAR(signed_volume(both.mesh(0)), 1, 1e-12);
  EXPECT_TRUE(both.add(make_box(Vec3(0.5, 0.1, 0.1), Vec3(1, 0.5, 0.5))));
}

// Down to the trunk alone: crowns are wider than they are long, and branches of all thicknesses meet.
TEST(MergeBelow, UnitesAllBranchesOfAModelledTree) {
  const SegmentedPlant tree = read_plant(LIANA_SOURCE_DIR "/data/plants/apple_small.glb");
  for (const int level : {0, 1}) {
    Progress silent;
    const SegmentedPlant merged = merge_below(tree, level, 1, silent).plant;
    for (size_t i = 0; i < merged.domains.size(); ++i) {
      const Domain& domain = merged.domains[i];
      if (domain.kind == DomainKind::Leaf) continue;
      EXPECT_LE(domain.level, level) << domain.name;
      const SolidDomain solid = make_solid(merged, DomainId(i));
      EXPECT_FALSE(solid.is_beam) << domain.name;
      EXPECT_EQ(solid.route.find("untangled"), std::string::npos) << domain.name << ": " << solid.route;
      EXPECT_GT(tetrahedralize(solid.surface, solid.is_root).tets.size(), 100u) << domain.name;
    }
  }
}

}  // namespace
}  // namespace liana
