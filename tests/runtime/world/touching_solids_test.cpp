#include "runtime/world/touching_solids.h"

#include <gtest/gtest.h>

#include "runtime/obstacles/box_mesh.h"
#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {
namespace {

StandingSolid box(const Vec3& low, const Vec3& high, double friction = 0.6) {
  return {box_mesh(low, high), {.friction = friction}};
}

TEST(TouchingSolids, TheFaceBetweenThemIsNoWayOut) {
  // A bar of 1 cm before a rail, face to face, and another rail that it touches as well.
  std::vector<StandingSolid> solids{box({-0.005, 0, -0.01}, {0.005, 1, 0}),
                                    box({-1, 0.2, 0}, {1, 0.23, 0.012}), box({-1, 0.7, 0}, {1, 0.73, 0.012})};
  unite_touching(solids);
  ASSERT_EQ(solids.size(), 1u);
  const SdfObstacle fence(solids[0].mesh, {.voxel = solids[0].voxel});
  // 1 mm behind the face between them the bar's sides are nearest: 5 mm, and what both have grown by.
  const SurfacePoint found = fence.closest_point({0, 0.215, -0.001});
  EXPECT_NEAR(found.distance, -0.0051, 1e-6);
  EXPECT_NEAR(std::abs(found.normal.x()), 1, 1e-9);
  EXPECT_NEAR(fence.closest_point({0.5, 0.215, 0.012}).distance, -1e-4, 1e-6)
      << "elsewhere, it is what it was";
}

TEST(TouchingSolids, WhatIsApartOrOfAnotherMaterialStaysItself) {
  std::vector<StandingSolid> solids{box({0, 0, 0}, {1, 1, 1}), box({1.001, 0, 0}, {2, 1, 1}),
                                    box({0, 1, 0}, {1, 2, 1}, 0.2)};
  const std::vector<StandingSolid> before = solids;
  unite_touching(solids);
  ASSERT_EQ(solids.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(solids[i].mesh.positions, before[i].mesh.positions) << i;
}

TEST(TouchingSolids, ASurfaceThroughItselfIsLeftAlone) {
  Mesh knot = box_mesh({0, 0, 0}, {1, 1, 1});
  for (Vec3& p : knot.positions)
    if (p == Vec3::Zero()) p = {0.4, 0.5, 1.5};  // out through the top
  std::vector<StandingSolid> solids{{knot, {}}, box({0, 0, 0.9}, {1, 1, 2})};
  unite_touching(solids);
  EXPECT_EQ(solids.size(), 2u);
}

}  // namespace
}  // namespace liana
