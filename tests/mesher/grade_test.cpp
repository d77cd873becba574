#include "mesher/solids/solidify/grade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

/// A prism of one segment, with the exact distance from its root cap on the walls.
MarkedSurface bare_prism(double length, double diameter) {
  const MarkedMesh tube =
      make_tube({.sides = 6, .length = length, .diameter = diameter, .stations = {0, length}});
  MarkedSurface surface{tube.mesh, {}, tube.is_root};
  for (const Vec3& p : tube.mesh.positions) surface.distance.push_back(p.y());
  return surface;
}

TEST(RingLevels, DoubleFromHalfADiameterThenStayBelowASixth) {
  for (const double ratio : {2.0, 5.0, 10.0, 30.0, 100.0}) {
    const double diameter = 0.01, length = ratio * diameter;
    std::vector<double> levels = ring_levels(length, diameter);
    ASSERT_GE(levels.size(), 5u);
    levels.push_back(length);
    double before = 0;
    for (const double level : levels) {
      EXPECT_GT(level, before);
      EXPECT_LE(level - before, length / 6 * (1 + 1e-9));
      before = level;
    }
    if (ratio >= 10) {
      EXPECT_DOUBLE_EQ(levels[0], 0.5 * diameter);
      EXPECT_DOUBLE_EQ(levels[1], 1.5 * diameter);
    }
  }
}

TEST(RingLevels, EndForARootWithoutWidthAndAreNoneWithoutLength) {
  EXPECT_LT(ring_levels(1, 0).size(), 40u);  // doubled from 1e-6 of the length: 20, and at most 6 even ones
  EXPECT_TRUE(ring_levels(0, 0).empty());
  EXPECT_TRUE(ring_levels(0, 0.01).empty());
  EXPECT_TRUE(ring_levels(std::numeric_limits<double>::infinity(), 0.01).empty());
  EXPECT_TRUE(ring_levels(std::nan(""), 0.01).empty());
}

TEST(Grade, GivesABarePrismTheWantedRingsAndKeepsItsShape) {
  for (const double ratio : {3.0, 10.0, 100.0}) {
    const double diameter = 0.02, length = ratio * diameter;
    MarkedSurface surface = bare_prism(length, diameter);
    const double volume = signed_volume(surface.mesh), area = surface_area(surface.mesh);
    const std::vector<double> levels = ring_levels(length, diameter);
    EXPECT_EQ(grade(surface, length, diameter), static_cast<int>(levels.size()));

    std::set<long> heights;  // in nanometres
    for (const Vec3& p : surface.mesh.positions) heights.insert(std::lround(p.y() * 1e9));
    EXPECT_EQ(heights.size(), levels.size() + 2);
    // Six vertices a ring, none on the diagonals of the flat sides: twelve triangles between rings, six a
    // cap.
    EXPECT_EQ(surface.mesh.triangles.size(), 12 * (levels.size() + 1) + 12);
    EXPECT_EQ(surface.mesh.positions.size(), 6 * (levels.size() + 2) + 2);
    // Every cut adds rounding of 1 ulp of a coordinate only.
    EXPECT_NEAR(signed_volume(surface.mesh) / volume, 1, 1e-13);
    EXPECT_NEAR(surface_area(surface.mesh) / area, 1, 1e-13);
    const Adjacency adjacency = find_adjacency(surface.mesh);
    EXPECT_TRUE(adjacency.closed && adjacency.oriented && adjacency.manifold);
    EXPECT_EQ(surface.distance.size(), surface.mesh.positions.size());
    ASSERT_EQ(surface.is_root.size(), surface.mesh.triangles.size());
    EXPECT_EQ(std::count(surface.is_root.begin(), surface.is_root.end(), 1), 6);
    EXPECT_FALSE(self_intersects(surface.mesh));
  }
}

TEST(Grade, LeavesASurfaceAloneThatIsFineEnough) {
  const MarkedMesh prism = make_prism(6, 1, 0.05);
  MarkedSurface surface{prism.mesh, {}, prism.is_root};
  for (const Vec3& p : prism.mesh.positions) surface.distance.push_back(p.y());
  EXPECT_EQ(grade(surface, 1, 0.05), 0);
  EXPECT_EQ(surface.mesh.triangles, prism.mesh.triangles);
}

TEST(Grade, MakesNoSliverWhereARingNearlyExists) {
  // A ring 1 % beside the level 0.5 d stands for it.
  const MarkedMesh tube =
      make_tube({.sides = 6, .length = 1, .diameter = 0.05, .stations = {0, 0.02525, 0.5, 1}});
  MarkedSurface surface{tube.mesh, {}, tube.is_root};
  for (const Vec3& p : tube.mesh.positions) surface.distance.push_back(p.y());
  grade(surface, 1, 0.05);
  const double shortest_wanted = 0.25 * 0.025;  // the snap distance
  for (const Triangle& t : surface.mesh.triangles)
    for (int k = 0; k < 3; ++k)
      EXPECT_GT((surface.mesh.positions[t[k]] - surface.mesh.positions[t[(k + 1) % 3]]).norm(),
                shortest_wanted);
}

}  // namespace
}  // namespace liana
