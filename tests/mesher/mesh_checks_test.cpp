#include "mesher/geometry/mesh_checks.h"

#include <gtest/gtest.h>

#include "mesher/geometry/weld.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

TEST(MeshChecks, TellClosedOpenAndTorn) {
  const Adjacency prism = find_adjacency(make_prism(6, 1, 0.05).mesh);
  EXPECT_TRUE(prism.closed && prism.oriented && prism.manifold);
  const Adjacency card = find_adjacency(make_leaf_card({}));
  EXPECT_TRUE(!card.closed && card.oriented && card.manifold);

  Mesh fin = make_box(Vec3::Zero(), Vec3::Ones());
  fin.positions.push_back(Vec3(2, 2, 2));
  fin.triangles.push_back({0, 1, 8});  // a third triangle on the edge 0-1
  EXPECT_FALSE(find_adjacency(fin).manifold);

  Mesh flipped = make_box(Vec3::Zero(), Vec3::Ones());
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_FALSE(find_adjacency(flipped).oriented);
}

TEST(MeshChecks, FindsTheTwoLoopsOfATube) {
  const Mesh tube = make_tube({.sides = 7, .stations = {}, .root_cap = false, .tip_cap = false}).mesh;
  const auto loops = border_loops(tube, find_adjacency(tube));
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 7u);
  EXPECT_EQ(loops[1].size(), 7u);
}

TEST(MeshChecks, KeepsLoopsApartThatShareAVertex) {
  // A 4 x 4 plate without two cells that meet at the middle vertex: one loop outside, and around the cells
  // either two loops or one, but every border edge exactly once.
  Mesh plate;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) plate.positions.push_back(Vec3(i, j, 0));
  for (uint32_t j = 0; j < 4; ++j)
    for (uint32_t i = 0; i < 4; ++i) {
      if ((i == 1 && j == 1) || (i == 2 && j == 2)) continue;
      const uint32_t a = 5 * j + i;
      plate.triangles.push_back({a, a + 1, a + 5});
      plate.triangles.push_back({a + 1, a + 6, a + 5});
    }
  size_t edges = 0;
  const auto loops = border_loops(plate, find_adjacency(plate));
  for (const auto& loop : loops) edges += loop.size();
  EXPECT_EQ(edges, 16u + 4 + 4);
  EXPECT_GE(loops.size(), 2u);
}

TEST(MeshChecks, CountsConnectedParts) {
  Mesh two = make_box(Vec3::Zero(), Vec3::Ones());
  const Mesh other = make_box(Vec3(3, 0, 0), Vec3::Ones());
  for (const Triangle& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
  uint32_t count = 0;
  const std::vector<uint32_t> part = connected_parts(find_adjacency(two), &count);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(part.front(), 0u);
  EXPECT_EQ(part.back(), 1u);
}

TEST(MeshChecks, AreaAndVolumeOfABoxFarFromTheOrigin) {
  // At 1e3 m the origin is a corner, so 16 digits leave 1e-13 of a coordinate, 1e-12 of the volume.
  const Mesh box = make_box(Vec3(1000, -2000, 500), Vec3(1, 2, 3));
  EXPECT_NEAR(surface_area(box), 22, 1e-10);
  EXPECT_NEAR(signed_volume(box), 6, 1e-11);
}

TEST(Weld, JoinsWhatIsWithinTheToleranceAndNothingElse) {
  // Two triangles over an edge given twice, 0.5e-9 apart in a box of diagonal ~1.4; then 1e-6 apart.
  for (const auto& [gap, vertices] : {std::pair{5e-10, 4u}, {1e-6, 6u}}) {
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0),       Vec3(1, 0, 0), Vec3(0, 1, 0),
                      Vec3(1 + gap, 0, 0), Vec3(1, 1, 0), Vec3(0, 1 + gap, 0)};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    const Mesh welded = weld(mesh);
    EXPECT_EQ(welded.positions.size(), vertices);
    EXPECT_EQ(welded.triangles.size(), 2u);
  }
}

TEST(Weld, DropsCollapsedTrianglesAndUnusedVertices) {
  Mesh mesh;
  mesh.positions = {Vec3(9, 9, 9), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)};
  mesh.triangles = {{1, 2, 3}, {2, 4, 3}};
  const Mesh welded = weld(mesh);
  EXPECT_EQ(welded.positions.size(), 3u);
  EXPECT_EQ(welded.triangles.size(), 1u);
  EXPECT_TRUE(weld(Mesh{}).triangles.empty());
}

}  // namespace
}  // namespace liana
