#include <gtest/gtest.h>

#include <map>

#include "mesher/base/error.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/triangle_tree.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/repair/mend.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "tests/support/solids/damage.h"

namespace liana {
namespace {

TEST(RepairLadder, WhateverIsDoneToATubeItIsASolidOrABeam) {
  std::mt19937 random(11);
  std::map<std::string, int> rungs;
  for (int round = 0; round < 150; ++round) {
    Mesh mesh = make_tube({.sides = 5 + int(random() % 4),
                           .length = 0.3,
                           .diameter = 0.02,
                           .tip_scale = 0.7,
                           .bend = 0.2 * double(random() % 4),
                           .stations = {0, 0.1, 0.2, 0.3},
                           .root_cap = random() % 2 == 0,
                           .tip_cap = random() % 2 == 0})
                    .mesh;
    const unsigned harms = random() % 4;
    for (unsigned i = 0; i < harms; ++i) harm(mesh, random);
    SegmentedPlant plant;
    plant.domains.push_back({.name = "tube", .parent = {}, .group = "g", .surface = weld(mesh)});
    try {
      const SolidDomain solid = make_solid(plant, DomainId(0));
      const bool wrapped = solid.route.find("alpha-wrapped") != std::string::npos;
      ++rungs[solid.is_beam                                        ? "beam"
              : wrapped                                            ? "alpha-wrapped"
              : solid.route.find("untangled") != std::string::npos ? "untangled"
                                                                   : "exact"];
      EXPECT_GT(solid.length, 0.22) << round << " " << solid.route;
      EXPECT_GT(solid.volume, 0) << round << " " << solid.route;
      EXPECT_GE(solid.centreline.size(), 2u) << round;
      if (solid.is_beam) continue;
      const Adjacency adjacency = find_adjacency(solid.surface);
      EXPECT_TRUE(adjacency.closed && adjacency.oriented && adjacency.manifold)
          << round << " " << solid.route;
      EXPECT_FALSE(self_intersects(solid.surface)) << round << " " << solid.route;
      EXPECT_GT(std::count(solid.is_root.begin(), solid.is_root.end(), 1), 0) << round << " " << solid.route;
    } catch (const Error& error) {
      ++rungs["refused"];
      ADD_FAILURE() << round << ": " << error.what();
    }
  }
  for (const auto& [rung, count] : rungs) std::printf("  %s %d\n", rung.c_str(), count);
  EXPECT_GT(rungs["exact"], 70);
}

TEST(Mend, LeavesASoundSurfaceAlone) {
  for (const Mesh& mesh : {make_prism(6, 1, 0.1).mesh, make_leaf_card({})}) {
    const Mended mended = mend(mesh);
    EXPECT_EQ(mended.notes, "");
    EXPECT_EQ(mended.mesh.triangles, mesh.triangles);
  }
}

TEST(Mend, KeepsTheVolumeOfWhatItMends) {
  const Mesh whole = make_tube({.length = 1, .diameter = 0.1, .stations = {0, 0.3, 0.7, 1}}).mesh;
  Mesh damaged = whole;
  add_septum(damaged, 6, 1);
  split_one_side(damaged, 3);
  add_fin(damaged, 30, 0.2);
  const Mended mended = mend(weld(damaged));
  EXPECT_TRUE(find_adjacency(mended.mesh).closed) << mended.notes;
  EXPECT_NEAR(signed_volume(mended.mesh) / signed_volume(whole), 1, 1e-12);
}

TEST(RepairLadder, SaysWhatItCost) {
  const MarkedMesh stem = make_prism(6, 1, 0.1);
  const double area = surface_area(stem.mesh), volume = signed_volume(stem.mesh);
  const auto solid_of = [](const Mesh& mesh) {
    SegmentedPlant plant;
    plant.domains.push_back({.name = "stem", .parent = {}, .group = "g", .surface = mesh});
    return make_solid(plant, DomainId(0));
  };
  const SolidDomain sound = solid_of(stem.mesh);
  EXPECT_NEAR(sound.lost_area, 0, 1e-12);
  EXPECT_NEAR(sound.lost_volume, 0, 1e-12);

  Mesh with_fin = stem.mesh;
  add_fin(with_fin, 0, 0.05);
  const double fin = surface_area(with_fin) - area;
  const SolidDomain finless = solid_of(with_fin);
  EXPECT_NEAR(finless.lost_area, fin / (area + fin), 1e-9) << finless.route;
  EXPECT_NEAR(finless.lost_volume, 0, 1e-9);

  Mesh with_crumb = stem.mesh;  // loose beside it
  const Mesh crumb = make_box(Vec3(0.1, 0.5, 0), Vec3(0.02, 0.02, 0.02));
  for (const Triangle& t : crumb.triangles) {
    const auto base = static_cast<uint32_t>(stem.mesh.positions.size());
    with_crumb.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  with_crumb.positions.insert(with_crumb.positions.end(), crumb.positions.begin(), crumb.positions.end());
  const SolidDomain crumbless = solid_of(with_crumb);
  EXPECT_NEAR(crumbless.lost_area, 0.0024 / (area + 0.0024), 1e-9) << crumbless.route;
  EXPECT_NEAR(crumbless.lost_volume, 8e-6 / volume, 1e-9);
}

TEST(TriangleTree, AgreesWithTheWholeSum) {
  const Mesh mesh = make_tube({.sides = 24, .length = 1, .diameter = 0.2, .bend = 1, .stations = {}}).mesh;
  const TriangleTree tree(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-0.3, 1.1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(at(random), at(random), at(random) / 4);
    double angle = 0, nearest = 1e9;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.positions[t[0]] - p, b = mesh.positions[t[1]] - p, c = mesh.positions[t[2]] - p;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      angle +=
          2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
      nearest = std::min({nearest, la, lb, lc});
    }
    EXPECT_NEAR(tree.winding_number(p), angle / (4 * kPi), 0.02);
    const auto hit = tree.nearest(p, 1e9);
    EXPECT_LE(hit.distance, nearest);
    EXPECT_NEAR((hit.point - p).norm(), hit.distance, 1e-12);
  }
}

}  // namespace
}  // namespace liana
