#include "mesher/solids/solidify/geodesic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

constexpr double kOnePercent = 0.01;  // what the header promises

/// Largest relative difference to an exact distance over the vertices farther than `near` from the source.
template <class Exact>
double worst_error(const Mesh& mesh, const std::vector<uint8_t>& source, double near, Exact exact) {
  const std::vector<double> distance = geodesic_distance(mesh, source);
  double worst = 0;
  for (size_t v = 0; v < distance.size(); ++v) {
    const double truth = exact(mesh.positions[v]);
    if (truth > near) worst = std::max(worst, std::abs(distance[v] / truth - 1));
  }
  return worst;
}

std::vector<uint8_t> sources(const Mesh& mesh, auto is_source) {
  std::vector<uint8_t> marked;
  for (const Vec3& p : mesh.positions) marked.push_back(is_source(p));
  return marked;
}

TEST(Geodesic, IsTheHeightOnAStraightTubeFromItsRing) {
  const Mesh tube = make_tube({.sides = 6, .stations = {}, .root_cap = false, .tip_cap = false}).mesh;
  const auto source = sources(tube, [](const Vec3& p) { return p.y() < 1e-9; });
  // A straight front over straight triangles: exact to rounding.
  EXPECT_LT(worst_error(tube, source, 0, [](const Vec3& p) { return p.y(); }), 1e-12);
}

TEST(Geodesic, FromOnePointOfAFlatSheetIsTheEuclideanDistance) {
  const Mesh card = make_leaf_card(
      {.length = 1, .width = 1, .along = 8, .across = 8, .bend = 0, .fold = 0, .pointed = false});
  const Vec3 corner = card.positions[0];
  const auto source = sources(card, [&](const Vec3& p) { return (p - corner).norm() < 1e-9; });
  // Circular fronts from one source unfold exactly.
  EXPECT_LT(worst_error(card, source, 0, [&](const Vec3& p) { return (p - corner).norm(); }), 1e-9);
}

TEST(Geodesic, FromAnEdgeOfAFlatSheetIsWithinOnePercent) {
  // A source a quarter as wide as the sheet: straight in front of it, fanning out beside it.
  const Mesh card = make_leaf_card(
      {.length = 2, .width = 1, .along = 16, .across = 8, .bend = 0, .fold = 0, .pointed = false});
  const double half = 0.125;
  const auto source =
      sources(card, [&](const Vec3& p) { return p.y() < 1e-9 && std::abs(p.x()) < half + 1e-9; });
  const auto exact = [&](const Vec3& p) { return std::hypot(p.y(), std::max(0.0, std::abs(p.x()) - half)); };
  EXPECT_LT(worst_error(card, source, 0.3, exact), kOnePercent);
}

TEST(Geodesic, FollowsTheInnerSideOfABentTube) {
  // The shortest way to the inner vertex of the tip ring runs along the inner side. The polygon inscribed in
  // the inner arc (radius R - r, 20 chords over 1 rad) is shorter than it by (1/20)²/24 = 1e-4.
  const double length = 1, bend = 1, radius = 0.05;
  std::vector<double> stations;
  for (int i = 0; i <= 20; ++i) stations.push_back(length * i / 20);
  const Mesh tube = make_tube({.sides = 8,
                               .length = length,
                               .diameter = 2 * radius,
                               .bend = bend,
                               .stations = stations,
                               .root_cap = false,
                               .tip_cap = false})
                        .mesh;
  const auto source = sources(tube, [](const Vec3& p) { return std::abs(p.y()) < 1e-9; });
  const std::vector<double> distance = geodesic_distance(tube, source);
  const size_t inner_tip = 20 * 8;  // corner 0 of a ring points to +x, where the tube bends to
  EXPECT_NEAR(distance[inner_tip] / ((length / bend - radius) * bend), 1, 3e-4);
  // Every other tip vertex: at least that, at most along its own generator.
  for (size_t i = 0; i < 8; ++i) {
    const double along = (length / bend - radius * std::cos(2 * kPi * double(i) / 8)) * bend;
    EXPECT_GE(distance[inner_tip + i], distance[inner_tip] - 1e-9);
    EXPECT_LE(distance[inner_tip + i], along);
  }
}

TEST(Geodesic, ScalesWithTheSurfaceAndIgnoresWhereItLies) {
  const Mesh leaf = make_leaf_card({});
  const auto source = sources(leaf, [](const Vec3& p) { return p.y() < 1e-9; });
  Affine3 move = Affine3::Identity();
  move.translate(Vec3(3, -1, 2)).rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).scale(1e-3);
  const std::vector<double> here = geodesic_distance(leaf, source);
  const std::vector<double> there = geodesic_distance(transformed(leaf, move), source);
  // At 3 m a coordinate is known to 4e-16, of a leaf of 6e-5 m: 1e-11 of its length; a hundred updates on the
  // way.
  for (size_t v = 0; v < here.size(); ++v) EXPECT_NEAR(there[v] * 1e3, here[v], 1e-9 * 0.06);
}

TEST(Geodesic, IsInfiniteWhereNoPathLeads) {
  Mesh two = make_box(Vec3::Zero(), Vec3::Ones());
  two.positions.push_back(Vec3(9, 9, 9));
  const std::vector<double> distance = geodesic_distance(two, {1, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(std::isinf(distance[8]));
  EXPECT_DOUBLE_EQ(distance[1], 1);
}

}  // namespace
}  // namespace liana
