#include "mesher/geometry/half_edge.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/base/random.h"
#include "mesher/geometry/fans.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

/// Closed and oriented, with one fan a vertex; unused vertices are no matter.
void expect_closed_manifold(const Mesh& mesh) {
  EXPECT_TRUE(is_oriented_manifold(mesh));
  EXPECT_TRUE(find_adjacency(mesh).closed);
}

/// Vertices in use minus edges plus triangles of a closed surface.
ptrdiff_t euler_characteristic(const Mesh& mesh) {
  std::vector<uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) used[v] = 1;
  return std::count(used.begin(), used.end(), 1) - static_cast<ptrdiff_t>(mesh.triangles.size() / 2);
}

TEST(HalfEdgeMesh, GivesBackTheTrianglesCornerByCorner) {
  for (const Mesh& mesh : {make_prism(6, 1, 0.05).mesh, make_leaf_card({})})
    EXPECT_EQ(HalfEdgeMesh(mesh).triangles(), mesh.triangles);
}

TEST(HalfEdgeMesh, WalksAroundTrianglesAndAcrossEdges) {
  const Mesh mesh = make_prism(6, 1, 0.05).mesh;
  const HalfEdgeMesh edges(mesh);
  const Adjacency adjacency = find_adjacency(mesh);
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const HalfEdge h = edges.half_edge(t, k);
      EXPECT_EQ(edges.from(h), mesh.triangles[t][k]);
      EXPECT_EQ(edges.to(h), mesh.triangles[t][(k + 1) % 3]);
      EXPECT_EQ(edges.apex(h), mesh.triangles[t][(k + 2) % 3]);
      EXPECT_EQ(edges.triangle(edges.opposite(h)), adjacency.across[t][k]);
      for (const HalfEdge out : edges.leaving(h)) EXPECT_EQ(edges.from(out), edges.from(h));
    }
}

TEST(HalfEdgeMesh, ASplitHalvesTheTrianglesInPlace) {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 3, 0}}};
  HalfEdgeMesh edges(square);
  edges.split(edges.opposite(edges.half_edge(0, 2)), 4);  // from 0 to 2: the halves at 0 stay
  EXPECT_EQ(edges.triangles(), (std::vector<Triangle>{{0, 1, 4}, {4, 3, 0}, {4, 1, 2}, {2, 3, 4}}));
  edges.split(edges.half_edge(0, 0), 5);  // on the border
  EXPECT_EQ(edges.triangles(),
            (std::vector<Triangle>{{0, 5, 4}, {4, 3, 0}, {4, 1, 2}, {2, 3, 4}, {5, 1, 4}}));
  EXPECT_EQ(edges.border_loops(), (std::vector<std::vector<uint32_t>>{{0, 5, 1, 2, 3}}));
}

TEST(HalfEdgeMesh, AFlipTurnsTheCommonEdge) {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 3, 0}}};
  HalfEdgeMesh edges(square);
  EXPECT_FALSE(edges.flip(edges.half_edge(0, 0)));  // on the border
  EXPECT_TRUE(edges.flip(edges.half_edge(0, 2)));   // a = 2, b = 0, c = 1, d = 3
  EXPECT_EQ(edges.triangles(), (std::vector<Triangle>{{2, 3, 1}, {3, 0, 1}}));
}

TEST(HalfEdgeMesh, ATetrahedronNeitherCollapsesNorFlips) {
  const Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  HalfEdgeMesh edges(tetrahedron);
  for (uint32_t t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k) {
      EXPECT_FALSE(edges.collapse(edges.half_edge(t, k)));
      EXPECT_FALSE(edges.flip(edges.half_edge(t, k)));
    }
  EXPECT_EQ(edges.triangles(), tetrahedron.triangles);
}

TEST(HalfEdgeMesh, ChangesAtRandomKeepASphereASphere) {
  Random random(1, "half-edges");
  Mesh mesh = make_prism(12, 1, 0.1).mesh;
  HalfEdgeMesh edges(mesh);
  int splits = 0, flips = 0, collapses = 0;
  for (int step = 0; step < 3000; ++step) {
    const auto triangle = static_cast<uint32_t>(random.uniform() * edges.triangle_count());
    if (edges.removed(triangle)) continue;
    const HalfEdge h = edges.half_edge(triangle, step % 3);
    const double kind = random.uniform();
    if (kind < 0.4) {
      const auto middle = static_cast<uint32_t>(mesh.positions.size());
      mesh.positions.push_back((mesh.positions[edges.from(h)] + mesh.positions[edges.to(h)]) / 2);
      edges.split(h, middle), ++splits;
    } else if (kind < 0.8) {
      flips += edges.flip(h);
    } else {
      collapses += edges.collapse(h);
    }
    if (step % 100 > 0) continue;
    mesh.triangles = edges.triangles();
    expect_closed_manifold(mesh);
    EXPECT_EQ(euler_characteristic(mesh), 2);
  }
  EXPECT_GT(std::min({splits, flips, collapses}), 100);
}

TEST(HalfEdgeMesh, SplitsAtRandomKeepAnOpenSheetsShape) {
  Random random(2, "half-edges");
  Mesh mesh = make_leaf_card({});
  const double area = surface_area(mesh);
  HalfEdgeMesh edges(mesh);
  for (int step = 0; step < 200; ++step) {
    const HalfEdge h(static_cast<size_t>(random.uniform() * edges.half_edge_count()));
    mesh.positions.push_back((mesh.positions[edges.from(h)] + mesh.positions[edges.to(h)]) / 2);
    edges.split(h, static_cast<uint32_t>(mesh.positions.size() - 1));
  }
  mesh.triangles = edges.triangles();
  EXPECT_TRUE(is_oriented_manifold(mesh));
  EXPECT_NEAR(surface_area(mesh), area, 1e-12 * area);
  const auto loops = edges.border_loops();
  EXPECT_EQ(loops, border_loops(mesh, find_adjacency(mesh)));
  EXPECT_EQ(loops.size(), 1u);
}

TEST(HalfEdgeMesh, TakesAFinApartAndKeepsItsTriangles) {
  Mesh fin = make_prism(6, 1, 0.05).mesh;  // a third triangle at an edge
  fin.positions.push_back({1, 1, 1});
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], uint32_t(fin.positions.size() - 1)});
  EXPECT_FALSE(is_oriented_manifold(fin));
  const HalfEdgeMesh edges(fin);
  EXPECT_EQ(edges.triangles(), fin.triangles);
}

TEST(HalfEdgeMesh, TakesNeighboursApartThatAreWoundAgainstOneAnother) {
  const Mesh twisted{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 2}}};
  const HalfEdgeMesh edges(twisted);
  EXPECT_EQ(edges.triangles(), twisted.triangles);
  EXPECT_EQ(edges.border_loops(), (std::vector<std::vector<uint32_t>>{{0, 1, 2}, {0, 3, 2}}));
}

TEST(HalfEdgeMesh, TwoSheetsThatTouchAtAVertexHaveTwoBorders) {
  const Mesh bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_FALSE(is_oriented_manifold(bow));
  EXPECT_EQ(HalfEdgeMesh(bow).border_loops(), (std::vector<std::vector<uint32_t>>{{0, 1, 2}, {0, 3, 4}}));
  const Fans fans = separate_fans(bow, find_adjacency(bow));
  EXPECT_EQ(fans.triangles, (std::vector<Triangle>{{0, 1, 2}, {5, 3, 4}}));
  EXPECT_EQ(fans.vertex, (std::vector<uint32_t>{0, 1, 2, 3, 4, 0}));
}

TEST(HalfEdgeMesh, TakesAnyTriangles) {
  Random random(3, "half-edges");
  for (int round = 0; round < 50; ++round) {
    Mesh soup{std::vector<Vec3>(8, Vec3::Zero()), {}};
    for (int i = 0; i < 30; ++i) {
      Triangle& t = soup.triangles.emplace_back();
      for (uint32_t& v : t) v = static_cast<uint32_t>(8 * random.uniform());
    }
    const HalfEdgeMesh edges(soup);
    EXPECT_EQ(edges.triangles(), soup.triangles);
    for (const auto& loop : edges.border_loops()) EXPECT_FALSE(loop.empty());
  }
}

}  // namespace
}  // namespace liana
