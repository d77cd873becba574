#include "runtime/picture/tube_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "runtime/picture/leaf_mesh.h"
#include "runtime/picture/smooth_normals.h"
#include "tests/support/scenes/draw_scenes.h"

namespace liana {
namespace {

Vec3 at(const glm::vec3& v) {
  return {v[0], v[1], v[2]};
}

TubeMesh mesh_of(const DrawTube& tube, int sides) {
  TubeMesh mesh;
  append_tube(tube, sides, mesh);
  return mesh;
}

DrawTube helix() {
  DrawTube tube;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.2 * i;
    tube.points.push_back({0.2 * std::cos(t), 0.03 * t, 0.2 * std::sin(t)});
    tube.radii.push_back(0.03 - 0.0004 * i);
  }
  return tube;
}

/// Every directed edge appears once, and so does its reverse.
bool closed(const std::vector<Triangle>& triangles) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const Triangle& t : triangles)
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.count({edge.second, edge.first})) return false;
  return true;
}

double volume(const TubeMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += at(mesh.vertices[t[0]].position)
               .dot(at(mesh.vertices[t[1]].position).cross(at(mesh.vertices[t[2]].position)));
  return sum / 6;
}

TEST(TubeMesh, IsClosedFiniteAndOutward) {
  const TubeMesh mesh = mesh_of(helix(), 8);
  EXPECT_TRUE(closed(mesh.triangles));
  EXPECT_GT(volume(mesh), 0);
  for (const TubeVertex& vertex : mesh.vertices) {
    EXPECT_TRUE(at(vertex.position).allFinite());
    EXPECT_NEAR(at(vertex.normal).norm(), 1, 1e-5);
  }
}

TEST(TubeMesh, VerticesLieAtTheRadius) {
  const DrawTube tube = helix();
  const int sides = 8;
  const TubeMesh mesh = mesh_of(tube, sides);
  for (size_t ring = 0; ring < tube.points.size(); ++ring)
    for (int k = 0; k < sides; ++k)  // single precision of positions below 1 m
      EXPECT_NEAR((at(mesh.vertices[ring * sides + k].position) - tube.points[ring]).norm(), tube.radii[ring],
                  1e-6);
}

TEST(TubeMesh, FramesDoNotTwistAlongAHelix) {
  const TubeMesh mesh = mesh_of(helix(), 8);
  // Neighbouring rings of a twist-free tube turn only with the curve: 0.2 rad of the helix a step.
  for (size_t ring = 0; ring + 1 < 60; ++ring)
    EXPECT_GT(at(mesh.vertices[8 * ring].normal).dot(at(mesh.vertices[8 * (ring + 1)].normal)),
              std::cos(0.25));
}

TEST(TubeMesh, VolumeOfACylinderWithManySides) {
  DrawTube tube;
  tube.points = {{0, 0, 0}, {0, 1, 0}};
  tube.radii = {0.1, 0.1};
  // A 64-gon's area is sin(2π/64)/(2π/64) = 0.9984 of its circle's; the tip adds at most a hemisphere (+6.7
  // %).
  const double cylinder = kPi * 0.01;
  EXPECT_GT(volume(mesh_of(tube, 64)), 0.998 * cylinder);
  EXPECT_LT(volume(mesh_of(tube, 64)), 1.067 * cylinder);
}

TEST(TubeMesh, RepeatedPointsAndSharpTurnsStayFinite) {
  DrawTube tube;
  tube.points = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 0}, {0, -1, 0}};  // and straight back
  tube.radii = {0.1, 0.1, 0, 0.05, 0.05, 0};
  const TubeMesh mesh = mesh_of(tube, 6);
  EXPECT_TRUE(closed(mesh.triangles));
  for (const TubeVertex& vertex : mesh.vertices)
    EXPECT_TRUE(at(vertex.position).allFinite() && at(vertex.normal).allFinite());
}

TEST(TubeMesh, OnePointDrawsNothing) {
  DrawTube tube;
  tube.points = {{1, 2, 3}, {1, 2, 3}};
  tube.radii = {0.1, 0.1};
  EXPECT_TRUE(mesh_of(tube, 6).triangles.empty());
}

TEST(LeafMesh, OutlinesFaceUpFillTheirUnitAndAreSymmetric) {
  for (const LeafOutline outline : {LeafOutline::Ivy, LeafOutline::Ovate}) {
    const LeafShape& shape = leaf_shape(outline);
    double area = 0, widest = 0, longest = 0, lopsided = 0;
    for (const glm::vec2& p : shape.points) {
      widest = std::max(widest, double(p.x));
      longest = std::max(longest, double(p.y));
      lopsided += p.x;
    }
    for (const Triangle& t : shape.triangles) {
      const glm::dvec2 u = shape.points[t[1]] - shape.points[t[0]],
                       v = shape.points[t[2]] - shape.points[t[0]];
      const double twice = u.x * v.y - u.y * v.x;
      EXPECT_GT(twice, 0);  // no overlap, faces +Z
      area += twice / 2;
    }
    EXPECT_NEAR(widest, 0.5, 1e-6);
    EXPECT_NEAR(longest, 1, 1e-6);
    EXPECT_NEAR(lopsided, 0, 1e-6);
    EXPECT_GT(area, 0.4);
    EXPECT_LT(area, 0.8);
  }
}

TEST(LeafMesh, MidribKeepsItsLengthWhateverItsCurl) {
  DrawLeaf leaf;
  leaf.length = 0.08;
  for (const double curl : {0.0, 0.5, -1.2, 2.5}) {
    leaf.curl = curl;
    double length = 0;
    const int steps = 1000;
    for (int i = 0; i < steps; ++i)
      length +=
          (blade_point(leaf, {0, float(i + 1) / steps}) - blade_point(leaf, {0, float(i) / steps})).norm();
    EXPECT_NEAR(length, leaf.length, 1e-5 * leaf.length);  // the polygon falls short by (curl/steps)²/24
  }
}

TEST(SmoothNormals, BoxKeepsItsEdges) {
  const Mesh box = support::box_mesh({0, 0, 0}, {1, 2, 3});
  for (const Vec3& normal : corner_normals(box)) EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-12);
}

}  // namespace
}  // namespace liana
