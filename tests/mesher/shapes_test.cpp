// The shapes that other tests rely on are what they claim.
#include "tests/support/solids/shapes.h"

#include <gtest/gtest.h>

#include <map>

namespace liana {
namespace {

double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles)
    six += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]]));
  return six / 6;
}

/// Directed edges without their opposite: 0 for a closed oriented surface.
int open_edges(const Mesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> count;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      ++count[{t[k], t[(k + 1) % 3]}];
      --count[{t[(k + 1) % 3], t[k]}];
    }
  int open = 0;
  for (const auto& [edge, n] : count) open += n > 0 ? n : 0;
  return open;
}

TEST(Shapes, PrismIsClosedOutwardAndHasItsVolume) {
  for (const int sides : {3, 6, 24}) {
    const MarkedMesh prism = make_prism(sides, 2, 0.1);
    EXPECT_EQ(open_edges(prism.mesh), 0);
    EXPECT_NEAR(signed_volume(prism.mesh), 2 * polygon_area(sides, 0.1), 1e-15);
    EXPECT_EQ(std::count(prism.is_root.begin(), prism.is_root.end(), 1), sides);
  }
}

TEST(Shapes, PolygonSecondMomentTendsToTheCircle) {
  EXPECT_NEAR(polygon_second_moment(1000, 2) / (kPi / 4), 1, 1e-4);
  EXPECT_NEAR(polygon_second_moment(4, std::sqrt(2.0)), 1.0 / 12, 1e-15);  // unit square
}

TEST(Shapes, GradedStationsDoubleFromHalfADiameterToASixthOfTheLength) {
  const std::vector<double> s = graded_stations(1, 0.05);
  EXPECT_DOUBLE_EQ(s[1], 0.025);
  EXPECT_DOUBLE_EQ(s[2], 0.075);
  EXPECT_DOUBLE_EQ(s[3], 0.175);
  EXPECT_DOUBLE_EQ(s.back(), 1);
  for (size_t i = 1; i < s.size(); ++i) EXPECT_LE(s[i] - s[i - 1], 1.0 / 6 + 1e-12);
}

TEST(Shapes, BoxIsClosedAndOutward) {
  const Mesh box = make_box(Vec3(1, 2, 3), Vec3(1, 2, 3));
  EXPECT_EQ(open_edges(box), 0);
  EXPECT_NEAR(signed_volume(box), 6, 1e-12);
}

TEST(Shapes, LeafCardFacesUpAndIsOneSided) {
  const Mesh card = make_leaf_card({.bend = 0, .fold = 0});
  for (const Triangle& t : card.triangles) {
    const Vec3 n =
        (card.positions[t[1]] - card.positions[t[0]]).cross(card.positions[t[2]] - card.positions[t[0]]);
    EXPECT_GT(n.z(), 0);
  }
  EXPECT_EQ(open_edges(card), 2 * (6 + 4));
}

}  // namespace
}  // namespace liana
