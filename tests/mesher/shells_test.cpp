// Merged meshes taken apart, and their hierarchy found.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/io/plant_file.h"
#include "mesher/shells/load_plant.h"
#include "mesher/shells/segment.h"
#include "mesher/shells/shell_shape.h"
#include "mesher/shells/split_shells.h"
#include "mesher/shells/unit_guess.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/hierarchy_score.h"
#include "tests/support/solids/shapes.h"
#include "tests/support/solids/skins.h"

namespace liana {
namespace {

void append(TriangleSoup& soup, const Mesh& mesh, const SoupLabel& label = {}) {
  const auto first = static_cast<uint32_t>(soup.positions.size());
  soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const Triangle& t : mesh.triangles)
    soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  soup.labels.push_back(label);
  soup.label.resize(soup.triangles.size(), static_cast<uint32_t>(soup.labels.size() - 1));
}

/// Every triangle with corners of its own, as flat shading exports them.
Mesh torn(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<uint32_t>(result.positions.size());
    for (const uint32_t v : t) result.positions.push_back(mesh.positions[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Mesh open_tube(double length, double diameter) {
  return make_tube({.length = length,
                    .diameter = diameter,
                    .stations = {0, length / 2, length},
                    .root_cap = false,
                    .tip_cap = false})
      .mesh;
}

Mesh moved(const Mesh& mesh, const Vec3& by) {
  return transformed(mesh, Affine3(Eigen::Translation3d(by)));
}

TEST(SplitShells, WeldsSeamsAndFlatShading) {
  TriangleSoup soup;
  append(soup, torn(make_prism(6, 1, 0.1).mesh));
  const Shells shells = split_shells(soup);
  ASSERT_EQ(shells.shells.size(), 1u);
  EXPECT_EQ(shells.index_parts, soup.triangles.size());
  EXPECT_EQ(shells.shells[0].surface.positions.size(), make_prism(6, 1, 0.1).mesh.positions.size());
}

TEST(SplitShells, JoinsLidsWithVerticesOfTheirOwn) {
  TriangleSoup soup;
  const MarkedMesh prism = make_prism(6, 1, 0.1);
  Mesh sides = prism.mesh, lid = prism.mesh;
  sides.triangles.clear(), lid.triangles.clear();
  for (size_t i = 0; i < prism.mesh.triangles.size(); ++i)
    (prism.is_root[i] ? lid : sides).triangles.push_back(prism.mesh.triangles[i]);
  append(soup, sides, {"a", "bark"});
  append(soup, lid, {"a", "cut wood"});
  EXPECT_EQ(split_shells(soup).index_parts, 2u);
  EXPECT_EQ(split_shells(soup).shells.size(), 1u);
}

TEST(SplitShells, KeepsBranchesApartWhoseRingsCoincide) {
  TriangleSoup soup;  // one goes on where the other ends, and a third starts there too
  append(soup, open_tube(1, 0.1));
  append(soup, moved(open_tube(0.5, 0.1), Vec3(0, 1, 0)));
  Shells shells = split_shells(soup);
  EXPECT_EQ(shells.shells.size(), 2u);
  EXPECT_EQ(shells.welded_parts, 1u);
  Mesh bent = moved(open_tube(0.5, 0.1), Vec3(0, 1, 0));
  for (Vec3& p : bent.positions) p.x() += p.y() - 1;
  append(soup, bent);
  shells = split_shells(soup);
  EXPECT_EQ(shells.shells.size(), 3u);
  EXPECT_EQ(shells.welded_parts, 1u);
}

TEST(SplitShells, KeepsABranchApartThatStartsInAnothersMiddleRing) {
  for (const bool flat_shaded : {false, true}) {
    TriangleSoup soup;
    const Mesh trunk = open_tube(1, 0.1),
               branch =
                   moved(transformed(open_tube(0.5, 0.1), Affine3(Eigen::AngleAxisd(0.0, Vec3::UnitX()))),
                         Vec3(0, 0.5, 0));
    Mesh bent = branch;
    for (Vec3& p : bent.positions)
      if (p.y() > 0.6) p.x() += (p.y() - 0.5);
    append(soup, flat_shaded ? torn(trunk) : trunk);
    append(soup, flat_shaded ? torn(bent) : bent);
    EXPECT_EQ(split_shells(soup).shells.size(), 2u) << flat_shaded;
  }
}

TEST(SplitShells, RemovesDoubledFacesAndCrumbs) {
  TriangleSoup soup;
  const Mesh card = make_leaf_card({});
  Mesh back = card;
  for (Triangle& t : back.triangles) std::swap(t[1], t[2]);
  append(soup, card), append(soup, back);
  soup.triangles.push_back({0, 0, 1}), soup.label.push_back(0);
  const Shells shells = split_shells(soup);
  ASSERT_EQ(shells.shells.size(), 1u);
  EXPECT_EQ(shells.doubled, card.triangles.size());
  EXPECT_EQ(shells.flat, 1u);
  EXPECT_EQ(shells.shells[0].surface.triangles.size(), card.triangles.size());
}

TEST(SplitShells, SeparatesALeafWeldedToItsTwigByMaterial) {
  TriangleSoup soup;
  const Mesh twig = open_tube(0.2, 0.01);
  append(soup, twig, {"tree", "bark"});
  const Triangle edge = twig.triangles[0];
  soup.positions.push_back(Vec3(0.1, 0.05, 0)), soup.labels.push_back({"tree", "leaf"});
  soup.triangles.push_back({edge[1], edge[0], uint32_t(soup.positions.size() - 1)}), soup.label.push_back(1);
  EXPECT_EQ(split_shells(soup).shells.size(), 2u);
}

TEST(ShellShape, TellsSheetsFromBodies) {
  EXPECT_TRUE(shape_of(make_leaf_card({})).sheet);
  EXPECT_TRUE(shape_of(make_leaf_card({.length = 0.5, .width = 0.01, .bend = 1.5, .pointed = false}))
                  .sheet);                                                      // grass
  EXPECT_TRUE(shape_of(make_box(Vec3::Zero(), Vec3(0.05, 0.1, 0.001))).sheet);  // a closed blade
  EXPECT_FALSE(shape_of(open_tube(0.3, 0.01)).sheet);
  EXPECT_FALSE(shape_of(make_prism(6, 0.3, 0.01).mesh).sheet);
  EXPECT_FALSE(
      shape_of(make_tube({.length = 1, .diameter = 0.04, .tip_scale = 0.1, .bend = 3, .stations = {}}).mesh)
          .sheet);
}

TEST(ShellShape, BonesFollowABentTube) {
  const ShellShape shape =
      shape_of(make_tube({.sides = 8, .length = 1, .diameter = 0.04, .bend = 1.5, .stations = {}}).mesh);
  // An arc of radius 1/1.5 about (2/3, 0, 0): the middles of level sets, which lean in the bend, lie on it to
  // within the tube's radius.
  for (const Bone& bone : shape.bones) EXPECT_NEAR((bone.from - Vec3(1 / 1.5, 0, 0)).norm(), 1 / 1.5, 0.02);
  EXPECT_NEAR(shape.length, 1, 0.06);  // along edges, from lid to lid
  ASSERT_GE(shape.ends.size(), 2u);
}

TEST(Segment, FindsTheHierarchyOfTheShippedPlants) {
  for (const std::string name : {"apple_small", "apple_tree", "ivy_sprig"}) {
    const std::string file = std::string(LIANA_SOURCE_DIR) + "/data/plants/" + name + ".glb";
    const HierarchyScore result = score(read_plant(file), load_plant(file, {.ignore_hierarchy = true}));
    EXPECT_EQ(result.found, result.domains) << name;
    EXPECT_GE(double(result.right), 0.99 * double(result.domains)) << name << ": " << result.wrong.front();
  }
}

/// Blender's Sapling, merged and exported by Blender (tests/data/make_merged_trees.py).
TEST(Segment, FindsTheHierarchyOfTreesMergedByBlender) {
  const std::string folder = std::string(LIANA_SOURCE_DIR) + "/tests/data/";
  for (const auto& [file, truth] : {std::pair("vine.ply", "vine"),
                                    {"vine_flat.glb", "vine"},
                                    {"forked.obj", "forked"},
                                    {"forked.ply", "forked"}}) {
    const HierarchyScore result = score(read_plant(folder + truth + "_truth.glb"), load_plant(folder + file));
    EXPECT_EQ(result.found, result.domains) << file;
    EXPECT_GE(double(result.right), 0.98 * double(result.domains)) << file << ": " << result.wrong.front();
  }
}

// Flat shading gives every triangle corners of its own, and nothing else tells neighbours from branches that
// touch.
TEST(Segment, FindsTheHierarchyOfFlatShadedTrees) {
  const std::string folder = LIANA_SOURCE_DIR;
  std::vector<SegmentedPlant> trees = {make_small_plant()};
  for (const char* file :
       {"/tests/data/forked_truth.glb", "/data/plants/apple_small.glb", "/data/plants/apple_tree.glb"})
    trees.push_back(read_plant(folder + file));
  for (const SegmentedPlant& truth : trees) {
    TriangleSoup soup;
    for (const Domain& domain : truth.domains) append(soup, torn(domain.surface));
    const HierarchyScore result = score(truth, segment(soup, Unit::Metre, truth.name));
    EXPECT_EQ(result.found, result.domains) << truth.name;
    EXPECT_GE(double(result.right), 0.98 * double(result.domains))
        << truth.name << ": " << result.wrong.front();
  }
}

SegmentedPlant loaded(const std::string& obj, const LoadOptions& options = {},
                      const std::string& name = "plant.obj") {
  const ScratchFolder folder;
  std::ofstream(folder / name) << obj;
  return load_plant(folder / name, options);
}

TEST(Segment, GuessesTheUnitAndSaysSo) {
  const SegmentedPlant truth = make_small_plant();  // 1.2 m, leaves of 6 cm
  for (const auto& [scale, name] :
       {std::pair(1.0, "metres"), {100.0, "centimetres"}, {1000.0, "millimetres"}}) {
    const SegmentedPlant plant = loaded(merged_obj(truth, false, scale));
    EXPECT_EQ(score(truth, plant).right, truth.domains.size()) << name;
    EXPECT_TRUE(std::any_of(plant.notes.begin(), plant.notes.end(),
                            [&, n = std::string("unit guessed: ") + name](const std::string& note) {
                              return note.starts_with(n);
                            }));
  }
  EXPECT_EQ(score(truth, loaded(merged_obj(truth, true, 10), {.unit = Unit::Metre})).found, 0u);
}

TEST(Segment, TurnsZUp) {
  SegmentedPlant truth = make_small_plant(), lying = truth;
  for (Domain& domain : lying.domains)
    for (Vec3& p : domain.surface.positions) p = Vec3(p.x(), -p.z(), p.y());
  EXPECT_EQ(score(truth, loaded(merged_obj(lying, false), {.up = UpAxis::Z})).right, truth.domains.size());
}

TEST(Segment, SeveralTrunksAndFloatingLeaves) {
  SegmentedPlant plant = make_small_plant();
  const size_t one = plant.domains.size();
  for (size_t i = 0; i < one; ++i) {
    Domain domain = plant.domains[i];
    domain.surface = moved(domain.surface, Vec3(5, 0, 0));
    if (domain.parent.valid()) domain.parent = DomainId(domain.parent.index() + one);
    domain.name += "b";
    plant.domains.push_back(domain);
  }
  // A leaf that has lost its petiole: 3 cm beside its twig.
  Mesh& leaf = plant.domains[3].surface;
  ASSERT_EQ(plant.domains[3].kind, DomainKind::Leaf);
  leaf = moved(leaf, 0.03 * (leaf.positions.back() - leaf.positions.front()).normalized());
  const SegmentedPlant found = loaded(merged_obj(plant, false));
  const HierarchyScore result = score(plant, found);
  EXPECT_EQ(result.right, plant.domains.size()) << result.wrong.front();
}

TEST(Segment, IsUnsureWhereTwoParentsAreAsNear) {
  TriangleSoup soup;
  append(soup, open_tube(1, 0.1));
  append(soup, moved(open_tube(1, 0.1), Vec3(0.3, 0, 0)));
  // A twig that starts in the middle between two stems.
  append(soup, transformed(open_tube(0.3, 0.02), Affine3(Eigen::Translation3d(0.15, 0.5, 0))));
  const SegmentedPlant plant = segment(soup, Unit::Metre, "x");
  ASSERT_EQ(plant.domains.size(), 3u);
  const auto twig =
      std::find_if(plant.domains.begin(), plant.domains.end(), [](auto& d) { return d.parent.valid(); });
  ASSERT_NE(twig, plant.domains.end());
  EXPECT_LT(twig->parent_confidence, 0.5);
}

TEST(Segment, NamesDomainsAfterObjectsAndKeepsNamesUnique) {
  TriangleSoup soup;
  append(soup, open_tube(1, 0.1), {"Stem", ""});
  append(soup,
         transformed(open_tube(0.3, 0.02),
                     Affine3(Eigen::Translation3d(0, 0.5, 0) * Eigen::AngleAxisd(1, Vec3::UnitX()))),
         {"branch1", ""});
  append(soup,
         transformed(open_tube(0.3, 0.02),
                     Affine3(Eigen::Translation3d(0, 0.7, 0) * Eigen::AngleAxisd(-1, Vec3::UnitX()))),
         {"", ""});
  const SegmentedPlant plant = segment(soup, Unit::Metre, "x");
  ASSERT_EQ(plant.domains.size(), 3u);
  EXPECT_EQ(plant.domains[0].name, "Stem");
  EXPECT_NE(plant.domains[1].name, plant.domains[2].name);
}

TEST(Segment, CutsASkinAndHangsOtherShellsOnItsParts) {
  TriangleSoup soup;
  append(soup, make_skin({{Vec3(0, 0, 0), Vec3(0, 1, 0), 0.05, 0.03},
                          {Vec3(0, 0.5, 0), Vec3(0.5, 0.8, 0), 0.025, 0.02}},
                         0.008));
  append(soup, transformed(open_tube(0.3, 0.015), Affine3(Eigen::Translation3d(0.4, 0.74, 0) *
                                                          Eigen::AngleAxisd(1.2, Vec3::UnitX()))));
  const SegmentedPlant plant = segment(soup, Unit::Metre, "x");
  ASSERT_EQ(plant.domains.size(), 3u);
  EXPECT_FALSE(plant.domains[0].parent.valid());
  EXPECT_EQ(plant.domains[1].parent, DomainId(0));
  EXPECT_EQ(plant.domains[1].parent_confidence, 1);
  EXPECT_EQ(plant.domains[2].parent, DomainId(1));
}

TEST(Segment, RefusesAMeshWithoutABranch) {
  try {
    SegmentedPlant leaf;
    leaf.domains.resize(1);
    leaf.domains[0].surface = make_leaf_card({});
    loaded(merged_obj(leaf, false));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("is a branch"), std::string::npos) << error.what();
    EXPECT_FALSE(error.hint.empty());
  }
}

TEST(Segment, SaysWhenNoTriangleHasAnArea) {
  TriangleSoup soup;
  soup.positions.assign(4, Vec3(1, 1, 1));
  soup.triangles = {{0, 1, 2}, {1, 2, 3}};
  soup.labels.resize(1);
  soup.label = {0, 0};
  try {
    segment(soup, Unit::Metre, "x");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has an area"), std::string::npos) << error.what();
  }
}

TEST(LoadPlant, TakesASegmentedFileAsItIs) {
  const ScratchFolder folder;
  SegmentedPlant plant = make_small_plant();
  std::swap(plant.domains[3].parent, plant.domains[6].parent);  // what no contact would tell
  plant.domains[3].parent = DomainId(0);
  plant.domains[3].level = 1;
  write_plant(plant, folder / "p.glb");
  const SegmentedPlant back = load_plant(folder / "p.glb");
  EXPECT_EQ(back.domains[3].parent, DomainId(0));
  EXPECT_EQ(back.domains[3].parent_confidence, 1);
}

TEST(LoadPlant, ScalesSegmentedFilesByTheUnit) {
  const ScratchFolder folder;
  const SegmentedPlant plant = make_small_plant();
  write_plant(plant, folder / "p.glb");
  const SegmentedPlant small = load_plant(folder / "p.glb", {.unit = Unit::Centimetre});
  const auto top = [](const SegmentedPlant& p) {
    double top = 0;
    for (const Vec3& v : p.domains[0].surface.positions) top = std::max(top, v.y());
    return top;
  };
  EXPECT_NEAR(top(small), 0.01 * top(plant), 1e-8);
}

TEST(UnitGuess, IsUnsureOnlyWhereSizesSayLittle) {
  EXPECT_EQ(guess_unit({.height = 250, .leaf_length = 8, .thin_branch = 0.5}).unit, Unit::Centimetre);
  EXPECT_EQ(guess_unit({.height = 250}).unit, Unit::Centimetre);
  EXPECT_EQ(guess_unit({.height = 20, .leaf_length = 0.1, .thin_branch = 0.008}).unit, Unit::Metre);
  EXPECT_LT(guess_unit({.height = 250, .leaf_length = 8, .thin_branch = 0.5}).doubt, 0.01);
  EXPECT_GT(guess_unit({.height = 30}).doubt, 0.1);
}

}  // namespace
}  // namespace liana
