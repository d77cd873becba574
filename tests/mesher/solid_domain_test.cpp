#include "mesher/solids/solidify/solid_domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesher/base/error.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/io/plant_file.h"
#include "tests/support/solids/damage.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

SegmentedPlant alone(const Mesh& surface, DomainKind kind = DomainKind::Branch) {
  SegmentedPlant plant;
  Domain domain;
  domain.name = "it";
  domain.group = "level0";
  domain.kind = kind;
  domain.surface = surface;
  plant.domains.push_back(domain);
  return plant;
}

/// A child surface on a vertical trunk of 0.1 m diameter whose axis is x = z = 0.
SegmentedPlant on_trunk(const Mesh& child, DomainKind kind = DomainKind::Branch) {
  SegmentedPlant plant = alone(make_tube({.sides = 12, .length = 2, .diameter = 0.1, .stations = {}}).mesh);
  plant.domains.push_back(
      {.name = "child", .parent = DomainId(0), .kind = kind, .level = 1, .group = "g", .surface = child});
  return plant;
}

SolidDomain solid_of(const Mesh& surface, DomainKind kind = DomainKind::Branch) {
  return make_solid(alone(surface, kind), DomainId(0));
}

Affine3 sideways(const Vec3& at) {  // local +y to world +x
  return Affine3(Eigen::Translation3d(at) * Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()));
}

double root_area(const SolidDomain& solid) {
  double area = 0;
  for (size_t i = 0; i < solid.is_root.size(); ++i)
    if (solid.is_root[i]) area += area_vector(solid.surface, solid.surface.triangles[i]).norm();
  return area;
}

void expect_valid(const SolidDomain& solid, const std::string& name) {
  const Adjacency adjacency = find_adjacency(solid.surface);
  EXPECT_TRUE(adjacency.closed && adjacency.oriented && adjacency.manifold) << name;
  EXPECT_GT(signed_volume(solid.surface), 0) << name;
  EXPECT_DOUBLE_EQ(solid.volume, signed_volume(solid.surface)) << name;
  EXPECT_FALSE(self_intersects(solid.surface)) << name;
  ASSERT_EQ(solid.is_root.size(), solid.surface.triangles.size()) << name;
  EXPECT_GT(std::count(solid.is_root.begin(), solid.is_root.end(), 1), 0) << name;
  EXPECT_GT(std::count(solid.is_root.begin(), solid.is_root.end(), 0), 0) << name;
  EXPECT_GT(solid.length, 0) << name;
  ASSERT_GE(solid.centreline.size(), 2u) << name;
  for (size_t i = 0; i < solid.centreline.size(); ++i) {
    const Section& section = solid.centreline[i];
    EXPECT_GE(section.half_width, section.half_thickness * (1 - 1e-12)) << name;
    EXPECT_GT(section.half_thickness, 0) << name;
    EXPECT_NEAR(section.thin_axis.norm(), 1, 1e-12) << name;
    if (i) {
      EXPECT_GT((section.centre - solid.centreline[i - 1].centre).norm(), 0) << name;
    }
  }
  EXPECT_FALSE(solid.route.empty()) << name;
}

TEST(SolidDomain, CapsAnOpenTubeAndKeepsItsWalls) {
  const Mesh open = make_tube({.sides = 8,
                               .length = 0.5,
                               .diameter = 0.02,
                               .stations = {0, 0.25, 0.5},
                               .root_cap = false,
                               .tip_cap = false})
                        .mesh;
  const SolidDomain solid = solid_of(open);
  expect_valid(solid, "tube");
  EXPECT_NEAR(solid.volume / (0.5 * polygon_area(8, 0.02)), 1, 1e-12);
  EXPECT_NEAR(root_area(solid) / polygon_area(8, 0.02), 1, 1e-12);
  EXPECT_LT((solid.root - Vec3::Zero()).norm(), 1e-12);  // the ground end
  EXPECT_NEAR(solid.length, 0.5, 1e-12);
  EXPECT_EQ(solid.route.rfind("capped", 0), 0u) << solid.route;
}

TEST(SolidDomain, TakesAClosedTubeAsItIs) {
  const MarkedMesh prism = make_prism(6, 1, 0.05);
  const SolidDomain solid = solid_of(prism.mesh);
  expect_valid(solid, "prism");
  EXPECT_EQ(solid.surface.triangles, prism.mesh.triangles);
  EXPECT_EQ(solid.is_root, prism.is_root);
  EXPECT_EQ(solid.route, "closed");
  // The surface as modelled has a tip cap: the farthest point is its centre, half a flat-to-flat width
  // further.
  EXPECT_NEAR(solid.length, 1 + 0.025 * std::cos(kPi / 6), 1e-9);
}

TEST(SolidDomain, TurnsInsideOutSurfacesOutward) {
  Mesh inward = make_prism(6, 1, 0.05).mesh;
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  const SolidDomain solid = solid_of(inward);
  expect_valid(solid, "inward");
  EXPECT_NEAR(solid.volume / polygon_area(6, 0.05), 1, 1e-12);
}

TEST(SolidDomain, WindsMixedTrianglesAlikeAndDropsDuplicates) {
  Mesh mixed = make_prism(6, 1, 0.05).mesh;
  for (size_t i = 0; i < mixed.triangles.size(); i += 3)
    std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  mixed.triangles.push_back(mixed.triangles[5]);
  const SolidDomain solid = solid_of(mixed);
  expect_valid(solid, "mixed");
  EXPECT_NEAR(solid.volume / polygon_area(6, 0.05), 1, 1e-12);
  EXPECT_NE(solid.route.find("duplicates-dropped"), std::string::npos) << solid.route;
}

TEST(SolidDomain, RemovesFlatTrianglesWithoutOpeningTheSurface) {
  // A T-junction closed with a flat triangle: a box edge split on one side only.
  Mesh box = make_box(Vec3::Zero(), Vec3(0.1, 1, 0.1));
  const Triangle t = box.triangles[0];
  const auto middle = static_cast<uint32_t>(box.positions.size());
  box.positions.push_back((box.positions[t[0]] + box.positions[t[1]]) / 2);
  box.triangles[0] = {t[0], middle, t[2]};
  box.triangles.push_back({middle, t[1], t[2]});
  box.triangles.push_back({t[0], t[1], middle});
  const SolidDomain solid = solid_of(box);
  expect_valid(solid, "t-junction");
  EXPECT_NEAR(solid.volume, 0.01, 1e-14);
  EXPECT_NE(solid.route.find("1-flat-removed"), std::string::npos) << solid.route;
}

TEST(SolidDomain, KeepsTheLargestOfSeveralShellsAndSaysSo) {
  Mesh shells = make_prism(6, 1, 0.05).mesh;
  const Mesh bud = make_box(Vec3(0.5, 0.5, 0), Vec3(0.01, 0.01, 0.01));
  const auto first = static_cast<uint32_t>(shells.positions.size());
  shells.positions.insert(shells.positions.end(), bud.positions.begin(), bud.positions.end());
  for (const Triangle& t : bud.triangles)
    shells.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const SolidDomain solid = solid_of(shells);
  expect_valid(solid, "shells");
  EXPECT_NEAR(solid.volume / polygon_area(6, 0.05), 1, 1e-12);
  EXPECT_NE(solid.route.find("largest-of-2-shells"), std::string::npos) << solid.route;
}

TEST(SolidDomain, HasItsRootWhereTheParentIs) {
  for (const bool capped : {false, true})
    for (const bool turned : {false, true}) {
      const TubeShape shape{.sides = 8,
                            .length = 0.6,
                            .diameter = 0.03,
                            .stations = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6},
                            .root_cap = capped,
                            .tip_cap = capped};
      // From the trunk's axis outward; turned: modelled from the far end.
      Affine3 place = sideways(Vec3(0, 1, 0));
      if (turned) place = place * Eigen::Translation3d(0, 0.6, 0) * Eigen::AngleAxisd(kPi, Vec3::UnitX());
      const SegmentedPlant plant = on_trunk(transformed(make_tube(shape).mesh, place));
      const SolidDomain solid = make_solid(plant, DomainId(1));
      expect_valid(solid, "child");
      EXPECT_LT((solid.root - Vec3(0, 1, 0)).norm(), 1e-9) << capped << turned;
      EXPECT_NEAR(root_area(solid) / polygon_area(8, 0.03), 1, 1e-9) << capped << turned;
    }
}

TEST(SolidDomain, RootIsTheEndInTheParentEvenIfTheTipComesBackToIt) {
  // Half a circle of radius 0.1 m: starts on the axis, its tip ends 0.15 m above, outside the bark by 0.05 m
  // less.
  const Mesh hook = make_tube({.sides = 8,
                               .length = kPi * 0.1,
                               .diameter = 0.01,
                               .bend = -2.6,
                               .stations = {},
                               .root_cap = false,
                               .tip_cap = false})
                        .mesh;
  const SegmentedPlant plant = on_trunk(transformed(hook, sideways(Vec3(0, 1, 0))));
  const SolidDomain solid = make_solid(plant, DomainId(1));
  EXPECT_LT((solid.root - Vec3(0, 1, 0)).norm(), 1e-9);
}

TEST(SolidDomain, LengthOfABentTubeIsItsLongestGeodesic) {
  // Between the centreline and the outer side: ℓ (1 + bend r/ℓ) at most.
  const double length = 1, radius = 0.02, bend = 1;
  const SolidDomain solid = solid_of(make_tube({.sides = 12,
                                                .length = length,
                                                .diameter = 2 * radius,
                                                .bend = bend,
                                                .stations = {},
                                                .root_cap = false,
                                                .tip_cap = false})
                                         .mesh);
  expect_valid(solid, "bent");
  EXPECT_GT(solid.length, length * 0.99);
  EXPECT_LT(solid.length, length + bend * radius);
}

TEST(SolidDomain, SectionsFollowABentTaperedTube) {
  const TubeShape shape{.sides = 16,
                        .length = 1,
                        .diameter = 0.04,
                        .tip_scale = 0.4,
                        .bend = 1.2,
                        .stations = {0,   .05, .1,  .15, .2,  .25, .3,  .35, .4,  .45, .5,
                                     .55, .6,  .65, .7,  .75, .8,  .85, .9,  .95, 1},
                        .root_cap = false,
                        .tip_cap = false};
  const SolidDomain solid = solid_of(make_tube(shape).mesh);
  expect_valid(solid, "tapered");
  const double arc_radius = shape.length / shape.bend;
  // The ellipse with the second moment I of a 16-gon of circumradius r has the half axis (4 I/π)^¼.
  const double per_radius = std::pow(4 / kPi * polygon_second_moment(16, 2), 0.25);
  for (size_t i = 1; i + 1 < solid.centreline.size(); ++i) {
    const Section& section = solid.centreline[i];
    // On the arc around (R, 0, 0): contours of distance lean towards the outside (the inner way is shorter),
    // which moves their middles along the tube and, by their lean over the arc, a little across it: 5 % of
    // the radius.
    const double across = (section.centre - Vec3(arc_radius, 0, 0)).norm() - arc_radius;
    EXPECT_LT(std::hypot(across, section.centre.z()), 0.05 * 0.02) << i;
    const double s = arc_radius * std::atan2(section.centre.y(), arc_radius - section.centre.x());
    const double radius = 0.02 * (1 - 0.6 * s);
    // Cuts across rings of chords: 16 chords over the arc and the tangent from neighbours, 2 %.
    EXPECT_NEAR(section.half_width / (per_radius * radius), 1, 0.02) << i;
    EXPECT_NEAR(section.half_thickness / (per_radius * radius), 1, 0.02) << i;
  }
}

TEST(SolidDomain, SectionsOfAFlatBladeAreItsWidthAndThickness) {
  const LeafCard shape{
      .length = 0.1, .width = 0.02, .along = 10, .across = 4, .bend = 0, .fold = 0, .pointed = false};
  SegmentedPlant plant = alone(make_leaf_card(shape));
  plant.domains[0].thickness = 5e-4;
  const SolidDomain solid = make_solid(plant, DomainId(0));
  expect_valid(solid, "blade");
  // Ellipse with the moments of a w × t rectangle: a = w (1/(3π))^¼, b = t (1/(3π))^¼.
  const double factor = std::pow(1 / (3 * kPi), 0.25);
  for (const Section& section : solid.centreline) {
    EXPECT_NEAR(section.half_width, factor * 0.02, 1e-9);
    EXPECT_NEAR(section.half_thickness, factor * 5e-4, 1e-9);
    EXPECT_NEAR(std::abs(section.thin_axis.z()), 1, 1e-6);
  }
  EXPECT_NEAR(solid.length, 0.1, 1e-9);
  EXPECT_LT((solid.centreline.front().centre - Vec3::Zero()).norm(), 1e-9);
  EXPECT_LT((solid.centreline.back().centre - Vec3(0, 0.1, 0)).norm(), 1e-3);
}

TEST(SolidDomain, ExtrudesASheetToAreaTimesThickness) {
  for (const double thickness : {1e-4, 3e-4, 1e-3}) {
    for (const bool pointed : {false, true}) {
      const Mesh card = make_leaf_card({.pointed = pointed});
      SegmentedPlant plant = alone(card, DomainKind::Leaf);
      plant.domains[0].thickness = thickness;
      const SolidDomain solid = make_solid(plant, DomainId(0));
      expect_valid(solid, "leaf");
      EXPECT_EQ(solid.route.rfind("sheet-extruded", 0), 0u) << solid.route;
      // First order exact; the next term is (t/2R)² with R the tightest turn: the fold of 0.4 rad across
      // cells of 1.5 mm at the narrow end, R ~ 4 mm: (1e-3/8e-3)² = 1.6 %, and 0.14 % at 0.3 mm.
      const double bound = std::pow(thickness / 8e-3, 2) + 1e-6;
      EXPECT_NEAR(solid.volume / (surface_area(card) * thickness), 1, bound) << thickness;
    }
  }
}

TEST(SolidDomain, TakesADoubleSidedCardAsOneSheet) {
  Mesh card = make_leaf_card({});
  const SolidDomain one = solid_of(card, DomainKind::Leaf);
  for (size_t i = 0, n = card.triangles.size(); i < n; ++i) {
    const Triangle t = card.triangles[i];
    card.triangles.push_back({t[0], t[2], t[1]});
  }
  const SolidDomain two = solid_of(card, DomainKind::Leaf);
  expect_valid(two, "double-sided");
  EXPECT_DOUBLE_EQ(two.volume, one.volume);
  EXPECT_NE(two.route.find("one-of-two-sides"), std::string::npos) << two.route;
}

TEST(SolidDomain, GradesACardOfOneQuadrangle) {
  const SolidDomain solid = solid_of(make_leaf_card(
      {.length = 0.1, .width = 0.01, .along = 1, .across = 1, .bend = 0, .fold = 0, .pointed = false}));
  expect_valid(solid, "quad");
  EXPECT_NEAR(solid.volume, 0.1 * 0.01 * 3e-4, 1e-12);
  EXPECT_GE(solid.surface.triangles.size(), 2u * 2 * 6);
  EXPECT_NEAR(root_area(solid), 0.01 * 3e-4, 1e-12);
}

TEST(SolidDomain, HoldsACardByItsWholeBaseEdgeHoweverFineItIs) {
  for (const int fine :
       {1, 3, 8, 16}) {  // 3 : 1, and as wide as long: which sides are long is for the parent to say
    for (const double width : {0.1, 0.3}) {
      const SolidDomain solid =
          make_solid(on_trunk(transformed(make_leaf_card({.length = 0.3,
                                                          .width = width,
                                                          .along = 3 * fine,
                                                          .across = fine,
                                                          .bend = 0,
                                                          .fold = 0,
                                                          .pointed = false}),
                                          Affine3(Eigen::Translation3d(0.05, 1, 0) *
                                                  Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()))),
                              DomainKind::Leaf),
                     DomainId(1));
      expect_valid(solid, "card");
      EXPECT_NEAR(root_area(solid), width * 3e-4, 1e-9) << fine;
      EXPECT_LT((solid.root - Vec3(0.05, 1, 0)).norm(), 1e-6) << fine;
      EXPECT_NEAR(solid.length, 0.3, 1e-3);
    }
  }
}

TEST(SolidDomain, HoldsAPointedLeafByTheSamePieceHoweverCoarseItIs) {
  // A rhombus of 0.1 by 0.04 m, of two triangles and of many; 4 % of its length are held.
  const auto rhombus = [](int n) {
    Mesh mesh;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const double u = double(i) / n, v = double(j) / n;
        mesh.positions.push_back(Vec3(0.02 * (u - v), 0.05 * (u + v), 0));
      }
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    return mesh;
  };
  const double side = 0.04 * 0.1;
  for (const int n : {1, 3, 20}) {
    const SolidDomain solid = solid_of(rhombus(n), DomainKind::Leaf);
    expect_valid(solid, "rhombus");
    EXPECT_NEAR(root_area(solid), 2 * side * 3e-4, 0.5 * side * 3e-4) << n;
    EXPECT_NEAR(solid.length, 0.1 - side, 0.5 * side) << n;
    EXPECT_NEAR(solid.volume, 0.002 * 3e-4, 1e-11) << n;
  }
}

TEST(SolidDomain, FindsALeafsBaseThoughItsBladeTouchesTheTwig) {
  // The base edge is at the trunk's bark (x = 0.05), and the blade leans so that its side runs into the bark.
  const LeafCard shape{.length = 0.06, .width = 0.04, .along = 10, .across = 4, .bend = 0, .fold = 0};
  const Affine3 place = Affine3(Eigen::Translation3d(0.05, 1, 0) * Eigen::AngleAxisd(-0.3, Vec3::UnitZ()));
  const SegmentedPlant plant = on_trunk(transformed(make_leaf_card(shape), place), DomainKind::Leaf);
  const SolidDomain solid = make_solid(plant, DomainId(1));
  expect_valid(solid, "leaf");
  EXPECT_LT((solid.root - Vec3(0.05, 1, 0)).norm(), 1e-3);
  EXPECT_NEAR(solid.length, 0.06, 6e-4);
}

TEST(SolidDomain, IsTheSameShapeWhereverItGrows) {
  const SegmentedPlant here = on_trunk(transformed(make_tube({.length = 0.4,
                                                              .diameter = 0.02,
                                                              .tip_scale = 0.3,
                                                              .bend = 0.4,
                                                              .stations = {},
                                                              .root_cap = false,
                                                              .tip_cap = false})
                                                       .mesh,
                                                   sideways(Vec3(0, 1, 0))));
  SegmentedPlant there = here;
  const Affine3 turn = Affine3(Eigen::Translation3d(2, 0.5, -1) * Eigen::AngleAxisd(2.1, Vec3::UnitY()));
  for (Domain& domain : there.domains) domain.surface = transformed(domain.surface, turn);
  const SolidDomain a = make_solid(here, DomainId(1)), b = make_solid(there, DomainId(1));
  ASSERT_EQ(a.surface.triangles, b.surface.triangles);
  EXPECT_EQ(a.is_root, b.is_root);
  for (size_t v = 0; v < a.surface.positions.size(); ++v)
    EXPECT_LT((turn * a.surface.positions[v] - b.surface.positions[v]).norm(), 1e-12);
  EXPECT_NEAR(a.length, b.length, 1e-12);
}

TEST(SolidDomain, SaysWhyADomainCannotBeMadeSolid) {
  const auto reason = [](const Mesh& mesh) -> std::string {
    try {
      make_solid(alone(mesh), DomainId(0));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Input);
      EXPECT_FALSE(error.hint.empty());
      EXPECT_NE(std::string(error.what()).find("'it'"), std::string::npos) << error.what();
      return error.what();
    }
    return "made solid";
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  Mesh lines;  // all in one line
  lines.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)};
  lines.triangles = {{0, 1, 2}, {1, 2, 3}};
  expect(reason(lines), "no area");

  // A closed envelope without volume: two triangulations of one flat square.
  Mesh envelope;
  envelope.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  envelope.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  expect(reason(envelope), "no volume");
}

TEST(SolidDomain, DamagedSurfacesEndInASolidOrInAReason) {
  const SegmentedPlant plain = make_small_plant();
  std::mt19937 random(3);
  int solids = 0, refused = 0;
  for (int round = 0; round < 60; ++round) {
    SegmentedPlant plant = plain;
    const size_t which = random() % plant.domains.size();
    Mesh& mesh = plant.domains[which].surface;
    for (unsigned i = 0; i <= random() % 4; ++i) {
      if (random() % 7 == 0)
        for (Vec3& p : mesh.positions) p.y() = 0;
      else
        harm(mesh, random);
    }
    mesh = weld(mesh);
    try {
      const SolidDomain solid = make_solid(plant, DomainId(which));
      if (!solid.is_beam) expect_valid(solid, std::to_string(round));
      ++solids;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Input);
      ++refused;
    }
  }
  EXPECT_GT(solids, 40);
  EXPECT_LT(refused, 20);  // flattened branches
}

TEST(SolidDomain, EveryDomainOfTheShippedAndSupportPlantsBecomesSolid) {
  std::vector<SegmentedPlant> plants = {make_small_plant()};
  for (const char* name : {"apple_small", "apple_tree", "ivy_sprig"})
    plants.push_back(read_plant(std::string(LIANA_SOURCE_DIR) + "/data/plants/" + name + ".glb"));
  EXPECT_GE(plants[1].domains.size(), 30u);
  EXPECT_LE(plants[1].domains.size(), 60u);
  EXPECT_GE(plants[2].domains.size(), 300u);
  for (const SegmentedPlant& plant : plants) {
    for (size_t i = 0; i < plant.domains.size(); ++i) {
      const std::string name = plant.name + "/" + plant.domains[i].name;
      const SolidDomain solid = make_solid(plant, DomainId(i));
      expect_valid(solid, name);
      // Sane sizes: nothing thinner than a leaf, slenderness as plants have it.
      EXPECT_GT(solid.length, 0.03) << name;
      EXPECT_LT(solid.length, 10) << name;
      if (plant.domains[i].kind == DomainKind::Branch) {
        EXPECT_GT(solid.centreline.back().half_thickness, 1e-3) << name;
        EXPECT_LT(solid.length / solid.centreline.front().half_width, 400) << name;
      } else {
        EXPECT_EQ(solid.route.rfind("sheet-extruded", 0), 0u) << name << " " << solid.route;
      }
    }
  }
}

}  // namespace
}  // namespace liana
