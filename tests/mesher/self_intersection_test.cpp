#include "mesher/exact/self_intersection.h"

#include <gtest/gtest.h>

#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

TEST(SelfIntersection, IsAbsentFromPrismsBoxesAndCards) {
  EXPECT_FALSE(self_intersects(make_prism(6, 1, 0.05).mesh));
  EXPECT_FALSE(self_intersects(make_box(Vec3::Zero(), Vec3::Ones())));
  EXPECT_FALSE(self_intersects(make_leaf_card({})));
}

TEST(SelfIntersection, IsFoundWhereATubeBendsThroughItself) {
  EXPECT_TRUE(self_intersects(make_tube({.length = 0.05, .diameter = 0.05, .bend = 3, .stations = {}}).mesh));
}

TEST(SelfIntersection, CountsDuplicatedAndFlatTriangles) {
  Mesh box = make_box(Vec3::Zero(), Vec3::Ones());
  box.triangles.push_back(box.triangles[0]);
  EXPECT_TRUE(self_intersects(box));
  Mesh flat;
  flat.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  flat.triangles = {{0, 1, 2}};
  EXPECT_TRUE(self_intersects(flat));
}

}  // namespace
}  // namespace liana
