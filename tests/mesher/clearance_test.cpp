#include "mesher/surface/clearance.h"

#include <gtest/gtest.h>

#include "mesher/base/random.h"
#include "mesher/surface/self_intersection.h"
#include "tests/support/large_plants.h"
#include "tests/support/shapes.h"

namespace liana {
namespace {

TEST(Clearance, IsProvedForPrismsBoxesTubesAndCards) {
  EXPECT_TRUE(surely_clear(make_prism(6, 1, 0.05).mesh));
  EXPECT_TRUE(surely_clear(make_box(Vec3::Zero(), Vec3::Ones())));
  EXPECT_TRUE(surely_clear(make_leaf_card({})));
  for (const Mesh& branch : make_branch_hierarchy(20).meshes) EXPECT_TRUE(surely_clear(branch));
}

TEST(Clearance, IsNotProvedWhereTrianglesTouch) {
  EXPECT_FALSE(surely_clear(make_tube({.length = 0.05, .diameter = 0.05, .bend = 3, .stations = {}}).mesh));
  // A tip on a face, a tip on an edge, two tips on one point, an edge through an edge.
  const std::vector<Vec3> base{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  for (const Vec3& tip : {Vec3(0.2, 0, 0.2), Vec3(0.5, 0, 0), Vec3(0, 0, 0), Vec3(0.3, -1e-3, 0.3)}) {
    Mesh mesh{base, {{0, 1, 2}, {3, 4, 5}}};
    mesh.positions.insert(mesh.positions.end(), {tip, tip + Vec3(0, 1, 0), tip + Vec3(0.1, 1, 0.1)});
    EXPECT_FALSE(surely_clear(mesh)) << tip.transpose();
  }
}

TEST(Clearance, IsNotProvedForFoldsFlatTrianglesAndPinchedVertices) {
  const std::vector<Vec3> fold{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.4, 0.8, 0)};
  EXPECT_FALSE(surely_clear({fold, {{0, 1, 2}, {1, 0, 3}}}));
  EXPECT_FALSE(surely_clear({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}}));
  Mesh two = make_box(Vec3::Zero(), Vec3::Ones());  // two boxes that share a corner
  const Mesh other = make_box(Vec3::Ones(), Vec3::Ones());
  for (const Triangle& t : other.triangles) {
    const auto moved = [](uint32_t v) { return v == 0 ? 7 : v + 7; };
    two.triangles.push_back({moved(t[0]), moved(t[1]), moved(t[2])});
  }
  two.positions.insert(two.positions.end(), other.positions.begin() + 1, other.positions.end());
  EXPECT_FALSE(surely_clear(two));
}

// Random triangles near one another, free or sharing a vertex or an edge: whatever is proved clear is clear
// by exact predicates, too. Coordinates on a coarse grid, so that they often touch exactly.
TEST(Clearance, NeverContradictsExactPredicates) {
  Random random(7, "triangles");
  int proved = 0;
  for (int round = 0; round < 3000; ++round) {
    Mesh mesh;
    for (int i = 0; i < 6; ++i)
      mesh.positions.push_back(Vec3(random.next() % 5, random.next() % 5, random.next() % 3));
    const uint32_t shared = round % 3;
    mesh.triangles = {{0, 1, 2},
                      shared == 0   ? Triangle{3, 4, 5}
                      : shared == 1 ? Triangle{0, 4, 5}
                                    : Triangle{1, 0, 5}};
    if (surely_clear(mesh)) {
      ++proved;
      EXPECT_FALSE(self_intersects_exactly(mesh)) << round;
    }
  }
  EXPECT_GT(proved, 500);
}

}  // namespace
}  // namespace liana
