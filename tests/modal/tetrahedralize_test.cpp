#include "mesher/tets/tetrahedralize.h"

#include <assert.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesher/base/error.h"
#include "mesher/tets/assertion_guard.h"
#include "tests/support/solids/block_tets.h"
#include "tests/support/solids/shapes.h"
#define TETLIBRARY
#include <tetgen.h>

// <assert.h> declares it only where assertions are on.
extern "C" [[noreturn]] void __assert_fail(const char*, const char*, unsigned, const char*) noexcept;

namespace liana {
namespace {

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const Vec3& o = mesh.positions[a];
    sum += (mesh.positions[b] - o).cross(mesh.positions[c] - o).dot(mesh.positions[d] - o) / 6;
  }
  return sum;
}

double area(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.root_faces)
    sum += (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm() / 2;
  return sum;
}

TEST(Tetrahedralize, FillsPrismsOfAllProportions) {
  for (const int sides : {3, 6, 8, 24})
    for (const double aspect : {2., 10., 100., 400.})
      for (const double length : {1e-4, 1., 50.}) {
        const MarkedMesh prism = make_prism(sides, length, length / aspect);
        const TetMesh tets = tetrahedralize(prism.mesh, prism.is_root);
        const double section = polygon_area(sides, length / aspect);
        // 1e-4 of the volume may go with slivers; on flat quads they have none.
        EXPECT_NEAR(volume(tets) / (section * length), 1, 1e-6) << sides << " " << aspect;
        EXPECT_NEAR(area(tets) / section, 1, 1e-6) << sides << " " << aspect;
        for (size_t i = 0; i < prism.mesh.positions.size(); ++i) {
          bool kept = false;
          for (size_t j = 0; j < prism.mesh.positions.size(); ++j)
            kept = kept || tets.positions[j] == prism.mesh.positions[i];
          EXPECT_TRUE(kept) << "vertex " << i << " moved";
        }
      }
}

TEST(Tetrahedralize, FillsBentAndTaperedTubes) {
  for (const double bend : {0.05, 0.5, 1.5})
    for (const double tip : {1., 0.5, 0.1}) {
      const MarkedMesh tube = make_tube(
          {.sides = 7, .length = 1, .diameter = 0.05, .tip_scale = tip, .bend = bend, .stations = {}});
      const TetMesh tets = tetrahedralize(tube.mesh, tube.is_root);
      double expected = 0;
      for (const auto& [a, b, c] : tube.mesh.triangles)
        expected += tube.mesh.positions[a].cross(tube.mesh.positions[b]).dot(tube.mesh.positions[c]) / 6;
      EXPECT_NEAR(volume(tets) / expected, 1, 1.01e-4);
      EXPECT_FALSE(tets.root_faces.empty());
    }
}

TEST(Tetrahedralize, IgnoresVerticesWithoutTriangles) {
  MarkedMesh prism = make_prism(6, 1, 0.1);
  prism.mesh.positions.insert(prism.mesh.positions.begin(), Vec3(100, std::nan(""), 0));
  for (Triangle& t : prism.mesh.triangles)
    for (uint32_t& v : t) ++v;
  EXPECT_NEAR(volume(tetrahedralize(prism.mesh, prism.is_root)), polygon_area(6, 0.1),
              1e-6 * polygon_area(6, 0.1));
}

/// What TetGen 1.5 aborts on, loops on or fills with nothing: each must be an Error that says why.
class BadSurface : public testing::Test {
 protected:
  MarkedMesh prism = make_prism(6, 1, 0.1);

  static std::string reason(const Mesh& mesh) {
    try {
      tetrahedralize(mesh, std::vector<uint8_t>(mesh.triangles.size(), 0));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Input);
      EXPECT_FALSE(error.hint.empty());
      return error.what();
    }
    return "accepted";
  }
  static bool says(const Mesh& mesh, const std::string& word) {
    const std::string text = reason(mesh);
    if (text.find(word) == std::string::npos) ADD_FAILURE() << text;
    return true;
  }
};

TEST_F(BadSurface, Empty) {
  says({}, "0 triangles");
}

TEST_F(BadSurface, OpenTube) {
  says(make_tube({.stations = {}, .root_cap = false, .tip_cap = false}).mesh, "open");
}

TEST_F(BadSurface, MissingTriangle) {
  prism.mesh.triangles.erase(prism.mesh.triangles.begin() + 7);
  says(prism.mesh, "open");
}

TEST_F(BadSurface, DuplicateTriangle) {
  prism.mesh.triangles.push_back(prism.mesh.triangles[5]);
  says(prism.mesh, "more than two");
}

TEST_F(BadSurface, TriangleTurnedOver) {
  std::swap(prism.mesh.triangles[3][0], prism.mesh.triangles[3][1]);
  says(prism.mesh, "orientation");
}

TEST_F(BadSurface, InsideOut) {
  for (Triangle& t : prism.mesh.triangles) std::swap(t[0], t[1]);
  says(prism.mesh, "inward");
}

TEST_F(BadSurface, SelfIntersection) {
  says(make_tube({.length = 0.05, .diameter = 0.05, .bend = 3, .stations = {}}).mesh, "cross");
  Mesh twice = make_box(Vec3::Zero(), Vec3::Ones());  // two boxes that overlap
  const Mesh other = make_box(Vec3(0.5, 0.4, 0.3), Vec3::Ones());
  for (Triangle t : other.triangles) twice.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  twice.positions.insert(twice.positions.end(), other.positions.begin(), other.positions.end());
  says(twice, "cross");
}

TEST_F(BadSurface, FlatCard) {
  says(make_leaf_card({.bend = 0, .fold = 0}), "open");
}

TEST_F(BadSurface, BentCard) {
  says(make_leaf_card({}), "open");
}

TEST_F(BadSurface, DoubleSidedCard) {
  for (const double bend : {0., 0.5}) {
    Mesh card = make_leaf_card({.bend = bend, .fold = 0});
    for (const Triangle t : std::vector(card.triangles)) card.triangles.push_back({t[0], t[2], t[1]});
    says(card, "more than two");
  }
}

TEST_F(BadSurface, BoxWithoutHeight) {
  says(make_box(Vec3::Zero(), Vec3(1, 1, 0)), "flat");
}

TEST_F(BadSurface, VertexOnAnEdge) {  // a T-junction: the edge's other triangle does not know of the vertex
  Mesh box = make_box(Vec3::Zero(), Vec3::Ones());
  const auto middle = static_cast<uint32_t>(box.positions.size());
  const Triangle first = box.triangles[0];
  box.positions.push_back((box.positions[first[0]] + box.positions[first[1]]) / 2);
  box.triangles[0] = {first[0], middle, first[2]};
  box.triangles.push_back({middle, first[1], first[2]});
  says(box, "open");
}

TEST_F(BadSurface,
       TriangleWithoutArea) {  // the same T-junction, closed by a triangle of three points in a line
  Mesh box = make_box(Vec3::Zero(), Vec3::Ones());
  const auto middle = static_cast<uint32_t>(box.positions.size());
  const Triangle first = box.triangles[0];
  box.positions.push_back((box.positions[first[0]] + box.positions[first[1]]) / 2);
  box.triangles[0] = {first[0], middle, first[2]};
  box.triangles.push_back({middle, first[1], first[2]});
  box.triangles.push_back({first[0], first[1], middle});
  const std::string text = reason(box);  // the jitter decides on which side of the edge the vertex lies
  EXPECT_TRUE(text == "accepted" || text.find("cannot fill") != std::string::npos) << text;
}

TEST_F(BadSurface, NotFinite) {
  prism.mesh.positions[4].y() = std::nan("");
  says(prism.mesh, "finite");
  prism.mesh.positions[4].y() = HUGE_VAL;
  says(prism.mesh, "finite");
}

TEST_F(BadSurface, IndexOutOfRange) {
  prism.mesh.triangles[4][1] = 4000;
  says(prism.mesh, "vertex 4000");
}

TEST_F(BadSurface, RepeatedCorner) {
  prism.mesh.triangles[4][1] = prism.mesh.triangles[4][0];
  says(prism.mesh, "twice");
}

TEST_F(BadSurface,
       CavityInside) {  // an inner shell with the other orientation: no tets may fill it, TetGen would
  Mesh box = make_box(Vec3::Zero(), Vec3::Ones());
  const Mesh inner = make_box(Vec3(0.3, 0.3, 0.3), Vec3(0.4, 0.4, 0.4));
  for (Triangle t : inner.triangles) box.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  box.positions.insert(box.positions.end(), inner.positions.begin(), inner.positions.end());
  says(box, "of its volume");
}

// shortdistance() asserts that its edge has a length. Without the guard the test would abort.
TEST(TetGenAssertions, BecomeFailures) {
  tetgenmesh mesh;
  double tip[3] = {0, 0, 1}, end[3] = {0, 0, 0};
  EXPECT_FALSE(survives_tetgen_assertions([&] { mesh.shortdistance(tip, end, end); }));
  EXPECT_TRUE(survives_tetgen_assertions([] {}));
  EXPECT_THROW(survives_tetgen_assertions([] { throw 3; }), int);
}

void fail_assertion(const char* expression) {
  __assert_fail(expression, "elsewhere.cpp", 1, "f");
}

TEST(TetGenAssertionsDeathTest, OfOthersAbortAsUsual) {
  survives_tetgen_assertions([] {});
  EXPECT_DEATH(fail_assertion("n >= 3"), "n >= 3");
  EXPECT_DEATH(survives_tetgen_assertions([] { fail_assertion("n >= 4"); }), "n >= 4");
}

TEST(TetGenAssertions, LeaveTheSymbolToTheCLibrary) {
  Dl_info found{};
  ASSERT_NE(dladdr(dlsym(RTLD_DEFAULT, "__assert_fail"), &found), 0);
  EXPECT_NE(std::string(found.dli_fname).find("libc.so"), std::string::npos) << found.dli_fname;
}

}  // namespace
}  // namespace liana
