#include "mesher/solids/skins/skin_cut.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "tests/support/solids/damage.h"
#include "tests/support/solids/shapes.h"
#include "tests/support/solids/skins.h"

namespace liana {
namespace {

/// A trunk, two branches on it and one twig on the first branch.
std::vector<SkinTube> known_tree() {
  return {{Vec3(0, 0, 0), Vec3(0, 1, 0), 0.05, 0.035},
          {Vec3(0, 0.4, 0), Vec3(0.4, 0.75, 0), 0.025, 0.02},
          {Vec3(0, 0.65, 0), Vec3(-0.35, 0.9, 0.1), 0.025, 0.018},
          {Vec3(0.2, 0.575, 0), Vec3(0.3, 0.6, 0.22), 0.013, 0.011}};
}

Vec3 middle_of(const Mesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : mesh.positions) sum += p;
  return sum / double(mesh.positions.size());
}

/// The tube whose middle is nearest to the piece's.
size_t tube_of(const SkinPiece& piece, const std::vector<SkinTube>& tubes) {
  const auto distance = [&](const SkinTube& t) {
    return ((t.root + t.tip) / 2 - middle_of(piece.surface)).norm();
  };
  return size_t(
      std::min_element(tubes.begin(), tubes.end(),
                       [&](const SkinTube& a, const SkinTube& b) { return distance(a) < distance(b); }) -
      tubes.begin());
}

void expect_solids_that_add_up(const std::vector<SkinPiece>& pieces, const Mesh& whole) {
  double volume = 0;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const Adjacency adjacency = find_adjacency(pieces[i].surface);
    EXPECT_TRUE(adjacency.closed && adjacency.manifold && adjacency.oriented) << i;
    EXPECT_FALSE(self_intersects(pieces[i].surface)) << i;
    EXPECT_GT(signed_volume(pieces[i].surface), 0) << i;
    EXPECT_LT(pieces[i].parent, static_cast<int>(i));
    EXPECT_EQ(pieces[i].parent < 0, i == 0);
    volume += signed_volume(pieces[i].surface);
  }
  EXPECT_NEAR(volume / signed_volume(whole), 1, 1e-12);  // the lids are the same on both sides
}

TEST(SkinCut, FindsTheBranchesOfAKnownTree) {
  const std::vector<SkinTube> tubes = known_tree();
  for (const double blend : {0.0, 0.02}) {
    const Mesh skin = make_skin(tubes, 0.008, blend);
    EXPECT_TRUE(is_branching_skin(skin));
    const std::vector<SkinPiece> pieces = cut_skin(skin);
    expect_solids_that_add_up(pieces, skin);
    ASSERT_EQ(pieces.size(), 4u);
    std::vector<int> piece_of(4, -1);
    for (size_t i = 0; i < 4; ++i) piece_of[tube_of(pieces[i], tubes)] = static_cast<int>(i);
    ASSERT_EQ(std::count(piece_of.begin(), piece_of.end(), -1), 0) << "every tube has its piece";
    EXPECT_EQ(pieces[size_t(piece_of[0])].parent, -1);
    EXPECT_EQ(pieces[size_t(piece_of[1])].parent, piece_of[0]);
    EXPECT_EQ(pieces[size_t(piece_of[2])].parent, piece_of[0]);
    EXPECT_EQ(pieces[size_t(piece_of[3])].parent, piece_of[1]);
  }
}

TEST(SkinCut, TheTrunkGoesOnThroughTheStraighterOfTwoForks) {
  const Mesh skin = make_skin({{Vec3(0, 0, 0), Vec3(0, 0.5, 0), 0.03, 0.03},
                               {Vec3(0, 0.48, 0), Vec3(0.08, 1.0, 0), 0.027, 0.02},
                               {Vec3(0, 0.48, 0), Vec3(-0.35, 0.85, 0), 0.027, 0.02}},
                              0.009);
  const std::vector<SkinPiece> pieces = cut_skin(skin);
  expect_solids_that_add_up(pieces, skin);
  ASSERT_EQ(pieces.size(), 2u);
  double highest = 0, leftmost = 0;
  for (const Vec3& p : pieces[0].surface.positions)
    highest = std::max(highest, p.y()), leftmost = std::min(leftmost, p.x());
  EXPECT_GT(highest, 0.99);
  EXPECT_GT(leftmost, -0.1);
}

TEST(SkinCut, LeavesATubeAndALeafWhole) {
  for (const Mesh& whole : {make_prism(8, 1, 0.05).mesh, make_box(Vec3::Zero(), Vec3(0.1, 1, 0.02)),
                            make_tube({.length = 0.6, .diameter = 0.05, .bend = 1.5, .stations = {}}).mesh,
                            make_skin({{Vec3(0, 0, 0), Vec3(0, 0.5, 0), 0.03, 0.03},  // a stub is no branch
                                       {Vec3(0, 0.2, 0), Vec3(0.05, 0.2, 0), 0.02, 0.02}},
                                      0.009)}) {
    EXPECT_FALSE(is_branching_skin(whole));
    const std::vector<SkinPiece> pieces = cut_skin(whole);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].parent, -1);
    EXPECT_EQ(pieces[0].surface.triangles.size(), whole.triangles.size());
  }
}

TEST(SkinCut, SaysWhatMendingTheSkinCost) {
  Mesh skin = make_skin(
      {{Vec3(0, 0, 0), Vec3(0, 1, 0), 0.05, 0.03}, {Vec3(0, 0.5, 0), Vec3(0.5, 0.8, 0), 0.025, 0.02}}, 0.008);
  const double area = surface_area(skin);
  EXPECT_EQ(cut_skin(skin)[0].lost_area, 0);
  add_fin(skin, 0, 0.02);
  const double fin = surface_area(skin) - area;
  const std::vector<SkinPiece> pieces = cut_skin(skin);
  EXPECT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(pieces[0].lost_area, fin / (area + fin), 1e-9);
  EXPECT_NEAR(pieces[0].lost_volume, 0, 1e-9);
}

}  // namespace
}  // namespace liana
