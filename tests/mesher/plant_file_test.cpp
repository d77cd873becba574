#include "mesher/io/plant_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

using nlohmann::json;

/// Without the flush to disk of write_file: these tests write hundreds of files.
void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// make_small_plant() as .gltf, changed by `change`, read back.
template <class Change>
SegmentedPlant read_changed(const ScratchFolder& folder, Change change) {
  const auto path = folder / "plant.gltf";
  write_plant(make_small_plant(), path);
  json gltf = json::parse(read_file(path));
  change(gltf);
  put(path, gltf.dump());
  return read_plant(path);
}

/// The message and hint of the Error that reading the changed plant ends in.
template <class Change>
std::string complaint(Change change) {
  const ScratchFolder folder;
  try {
    read_changed(folder, change);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Input);
    EXPECT_NE(std::string(error.what()).find("plant.gltf"), std::string::npos) << error.what();
    EXPECT_FALSE(error.hint.empty()) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read without complaint";
  return {};
}

int node_named(const json& gltf, const std::string& name) {
  for (size_t i = 0; i < gltf["nodes"].size(); ++i)
    if (gltf["nodes"][i]["name"] == name) return static_cast<int>(i);
  return -1;
}

json& position_accessor(json& gltf, const std::string& node) {
  const int mesh = gltf["nodes"][node_named(gltf, node)]["mesh"];
  return gltf["accessors"][int(gltf["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"])];
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(PlantFile, WritesWhatItReads) {
  const ScratchFolder folder;
  SegmentedPlant plant = make_small_plant();
  plant.domains[4].group = "spur";
  plant.domains.back().thickness = 5e-4;
  for (const char* name : {"plant.glb", "plant.gltf"}) {
    write_plant(plant, folder / name);
    const SegmentedPlant back = read_plant(folder / name);
    ASSERT_EQ(back.domains.size(), plant.domains.size());
    EXPECT_EQ(back.name, "plant");
    EXPECT_NE(back.source_hash, 0u);
    for (size_t i = 0; i < plant.domains.size(); ++i) {
      const Domain &a = plant.domains[i], &b = back.domains[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.parent, b.parent);
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.level, b.level);
      EXPECT_EQ(a.group, b.group);
      EXPECT_EQ(a.thickness, b.thickness);
      ASSERT_EQ(a.surface.triangles.size(), b.surface.triangles.size());
      // Stored as floats relative to the centre of a domain of at most 1.2 m: half an ulp of 0.6 is 3e-8.
      for (size_t t = 0; t < a.surface.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
          EXPECT_LT((a.surface.positions[a.surface.triangles[t][k]] -
                     b.surface.positions[b.surface.triangles[t][k]])
                        .norm(),
                    1e-7);
    }
  }
}

TEST(PlantFile, ComposesTransformsAndFlipsMirroredSurfaces) {
  const ScratchFolder folder;
  const SegmentedPlant plain = make_small_plant();
  const SegmentedPlant moved = read_changed(folder, [](json& gltf) {
    // The scene's tops under a node without mesh that mirrors x, doubles sizes and lifts by 1 m.
    gltf["nodes"].push_back({{"name", "group"},
                             {"children", gltf["scenes"][0]["nodes"]},
                             {"scale", {-2, 2, 2}},
                             {"translation", {0, 1, 0}}});
    gltf["scenes"][0]["nodes"] = {gltf["nodes"].size() - 1};
  });
  ASSERT_EQ(moved.domains.size(), plain.domains.size());
  for (size_t i = 0; i < plain.domains.size(); ++i) {
    const Mesh &a = plain.domains[i].surface, &b = moved.domains[i].surface;
    EXPECT_EQ(plain.domains[i].parent, moved.domains[i].parent);
    for (size_t t = 0; t < a.triangles.size(); ++t) {
      Triangle turned = b.triangles[t];
      std::swap(turned[1], turned[2]);
      for (int k = 0; k < 3; ++k) {
        const Vec3& p = a.positions[a.triangles[t][k]];
        EXPECT_LT((b.positions[turned[k]] - Vec3(-2 * p.x(), 2 * p.y() + 1, 2 * p.z())).norm(), 2e-7);
      }
    }
  }
}

TEST(PlantFile, AttachesThroughNodesWithoutMesh) {
  const ScratchFolder folder;
  const SegmentedPlant plant = read_changed(folder, [](json& gltf) {
    json& branch = gltf["nodes"][node_named(gltf, "branch1")];
    const json children = branch["children"];
    branch["children"] = {gltf["nodes"].size()};
    gltf["nodes"].push_back({{"children", children}});
  });
  const auto parents = [](const SegmentedPlant& p) {
    std::map<std::string, std::string> names;
    for (const Domain& d : p.domains)
      names[d.name] = d.parent.valid() ? p.domains[d.parent.index()].name : "";
    return names;
  };
  EXPECT_EQ(parents(plant), parents(make_small_plant()));
}

TEST(PlantFile, WeldsVerticesSplitAtSeams) {
  SegmentedPlant plant = make_small_plant();
  Mesh& trunk = plant.domains[0].surface;
  const size_t vertices = trunk.positions.size(), triangles = trunk.triangles.size();
  Mesh split;  // every triangle with corners of its own, one of them without area
  for (const Triangle& t : trunk.triangles) {
    const auto first = static_cast<uint32_t>(split.positions.size());
    for (const uint32_t v : t) split.positions.push_back(trunk.positions[v]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  split.triangles.push_back({0, 0, 1});
  trunk = split;
  const ScratchFolder folder;
  write_plant(plant, folder / "split.glb");
  const Mesh welded = read_plant(folder / "split.glb").domains[0].surface;
  EXPECT_EQ(welded.positions.size(), vertices);
  EXPECT_EQ(welded.triangles.size(), triangles);
}

TEST(PlantFile, TakesTheKindFromTheNameWhenExtrasAreSilent) {
  const ScratchFolder folder;
  const std::vector<std::pair<const char*, DomainKind>> names = {
      {"Leaf.012", DomainKind::Leaf},    {"big_LEAVES", DomainKind::Leaf},   {"petal", DomainKind::Leaf},
      {"grass blade", DomainKind::Leaf}, {"overleafed", DomainKind::Branch}, {"cleaf", DomainKind::Branch}};
  for (const auto& [name, kind] : names) {
    const SegmentedPlant plant = read_changed(folder, [&, n = name](json& gltf) {
      for (json& node : gltf["nodes"]) node.erase("extras");
      gltf["nodes"][node_named(gltf, "leaf1.1")]["name"] = n;
    });
    const Domain& domain = plant.domains[3];
    EXPECT_EQ(domain.name, name);
    EXPECT_EQ(domain.kind, kind) << name;
    EXPECT_EQ(domain.group, kind == DomainKind::Leaf ? "leaf" : "level3") << name;
  }
}

TEST(PlantFile, MakesNamesUniqueAndAllowsSeveralTrunks) {
  const ScratchFolder folder;
  const SegmentedPlant plant = read_changed(folder, [](json& gltf) {
    for (json& node : gltf["nodes"]) node["name"] = "x";
    // The first branch becomes a second trunk.
    json& trunk = gltf["nodes"][0]["children"];
    gltf["scenes"][0]["nodes"].push_back(trunk[0]);
    trunk.erase(0);
  });
  std::set<std::string> names;
  for (const Domain& domain : plant.domains) names.insert(domain.name);
  EXPECT_EQ(names.size(), plant.domains.size());
  ASSERT_EQ(plant.notes.size(), 1u);
  EXPECT_NE(plant.notes[0].find("numbered, as 'x~2'"), std::string::npos) << plant.notes[0];
  EXPECT_EQ(
      std::count_if(plant.domains.begin(), plant.domains.end(), [](auto& d) { return !d.parent.valid(); }),
      2);
}

TEST(PlantFile, ReadsStripsAndFans) {
  // A unit square as strip and as fan, wound counter-clockwise: area 1, normal +z.
  const ScratchFolder folder;
  for (const auto& [mode, order] : {std::pair{5, std::array{0, 1, 3, 2}}, {6, std::array{0, 1, 2, 3}}}) {
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    std::string bytes;
    for (const int i : order) bytes.append(reinterpret_cast<const char*>(corners[i]), 12);
    put(folder / "data.bin", bytes);
    const json gltf = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"uri", "data.bin"}, {"byteLength", 48}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 48}}}},
        {"accessors", {{{"bufferView", 0}, {"count", 4}, {"type", "VEC3"}, {"componentType", 5126}}}},
        {"meshes", {{{"primitives", {{{"mode", mode}, {"attributes", {{"POSITION", 0}}}}}}}}},
        {"nodes", {{{"mesh", 0}}}}};
    put(folder / "square.gltf", gltf.dump());
    const Mesh square = read_plant(folder / "square.gltf").domains[0].surface;
    ASSERT_EQ(square.triangles.size(), 2u);
    for (const Triangle& t : square.triangles) {
      const Vec3 a = square.positions[t[0]], b = square.positions[t[1]], c = square.positions[t[2]];
      EXPECT_GT((b - a).cross(c - a).z(), 0);
    }
  }
}

TEST(PlantFile, NamesMissingTruncatedAndRandomFiles) {
  const ScratchFolder folder;
  EXPECT_THROW(read_plant(folder / "none.glb"), Error);
  const auto path = folder / "plant.glb";
  write_plant(make_small_plant(), path);
  const std::string whole = read_file(path);
  for (size_t i = 0; i < 200; ++i) {
    put(path, whole.substr(0, whole.size() * i / 200));
    EXPECT_THROW(read_plant(path), Error) << "cut to " << whole.size() * i / 200;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    std::string noise(300, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    if (i % 2) noise.replace(0, 12, whole.substr(0, 12));  // behind a valid header
    put(path, noise);
    EXPECT_THROW(read_plant(path), Error);
  }
}

TEST(PlantFile, SurvivesFlippedBytes) {
  const ScratchFolder folder;
  const auto path = folder / "plant.glb";
  write_plant(make_small_plant(), path);
  const std::string whole = read_file(path);
  std::mt19937 random(2);
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    std::string damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    put(path, damaged);
    try {
      EXPECT_FALSE(read_plant(path).domains.empty());
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(PlantFile, RefusesHierarchiesThatAreNotForests) {
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][node_named(g, "leaf1.1")]["children"] = {0}; }),
                  "cycle");
  EXPECT_MENTIONS(
      complaint([](json& g) { g["nodes"][node_named(g, "leaf1.1")]["children"] = {node_named(g, "twig2")}; }),
      "'twig2' hangs on two parents");
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][1]["children"] = {99}; }),
                  "child 99, which does not exist");
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][0]["children"] = json::array({1}); }),
                  "has neither a parent nor a place in a scene");
  EXPECT_MENTIONS(complaint([](json& g) {
                    json& children = g["nodes"][node_named(g, "twig1")]["children"];
                    g["scenes"][0]["nodes"].push_back(children[0]);
                    children.erase(0);
                  }),
                  "'leaf1.1': is a leaf without a parent branch");
  EXPECT_MENTIONS(complaint([](json& g) { g["scenes"][0]["nodes"] = {77}; }), "node 77");
  EXPECT_MENTIONS(complaint([](json& g) {
                    for (json& n : g["nodes"]) n.erase("mesh");
                  }),
                  "no node");
}

TEST(PlantFile, RefusesBrokenMeshes) {
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][2]["mesh"] = 7000; }), "mesh 7000");
  EXPECT_MENTIONS(complaint([](json& g) { g["meshes"][0]["primitives"] = json::array(); }), "'trunk'");
  EXPECT_MENTIONS(complaint([](json& g) { g["meshes"][0]["primitives"][0]["mode"] = 1; }), "points or lines");
  EXPECT_MENTIONS(complaint([](json& g) { g["meshes"][0]["primitives"][0]["indices"] = 4711; }),
                  "plant.gltf");
  EXPECT_MENTIONS(complaint([](json& g) { position_accessor(g, "twig1")["count"] = 1000000; }),
                  "reaches beyond its buffer view");
  EXPECT_MENTIONS(complaint([](json& g) { position_accessor(g, "twig1")["count"] = 3; }), "names vertex");
  EXPECT_MENTIONS(complaint([](json& g) { position_accessor(g, "twig1")["componentType"] = 5123; }),
                  "not three floats");
  EXPECT_MENTIONS(complaint([](json& g) { position_accessor(g, "twig1")["bufferView"] = 555; }),
                  "buffer view");
  EXPECT_MENTIONS(complaint([](json& g) { g["bufferViews"][0]["byteLength"] = 1 << 30; }),
                  "beyond its buffer");
  EXPECT_MENTIONS(complaint([](json& g) {
                    json& view = g["bufferViews"][int(position_accessor(g, "trunk")["bufferView"])];
                    view["byteOffset"] = std::numeric_limits<int64_t>::max();
                  }),
                  "plant.gltf");
}

TEST(PlantFile, RefusesAbsurdGeometryAndTransforms) {
  const auto scaled = [](double x, double y, double z) {
    return complaint([=](json& g) { g["nodes"][0]["scale"] = {x, y, z}; });
  };
  EXPECT_MENTIONS(scaled(0, 1, 1), "'trunk' has a transform that flattens it");
  EXPECT_MENTIONS(scaled(1e9, 1e9, 1e9), "reaches further than");
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][0]["rotation"] = {0, 0, 0, 0}; }), "unit quaternion");
  EXPECT_MENTIONS(complaint([](json& g) { g["nodes"][0]["matrix"] = {1, 2, 3}; }), "wrong number of values");

  const ScratchFolder folder;
  SegmentedPlant plant = make_small_plant();
  plant.domains[3].surface.positions[5].y() = std::numeric_limits<double>::quiet_NaN();
  write_plant(plant, folder / "nan.glb");
  try {
    read_plant(folder / "nan.glb");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_MENTIONS(std::string(error.what()), plant.domains[3].name);
    EXPECT_MENTIONS(std::string(error.what()), "not a finite number");
  }
  for (Vec3& p : plant.domains[3].surface.positions) p = Vec3(1, 2, 3);
  write_plant(plant, folder / "point.glb");
  EXPECT_THROW(read_plant(folder / "point.glb"), Error);
}

TEST(PlantFile, RefusesExtrasOfAnotherForm) {
  const auto with = [](const json& liana) {
    return complaint([&](json& g) { g["nodes"][1]["extras"]["liana"] = liana; });
  };
  EXPECT_MENTIONS(with({{"kind", "flower"}}), "kind");
  EXPECT_MENTIONS(with({{"thickness", -1}}), "thickness");
  EXPECT_MENTIONS(with({{"thickness", "thin"}}), "thickness");
  EXPECT_MENTIONS(with({{"grup", "x"}}), "unknown key 'grup'");
  EXPECT_MENTIONS(with(3), "not an object");
}

TEST(PlantFile, NeverReadsBuffersOutsideItsFolder) {
  const ScratchFolder outside;
  put(outside / "data.bin", std::string(1 << 20, 'x'));
  const std::string up = "../" + (outside / "data.bin").parent_path().filename().string() + "/data.bin";
  for (const std::string& uri : {up, (outside / "data.bin").string(), std::string("missing.bin")})
    EXPECT_MENTIONS(complaint([&](json& g) { g["buffers"][0]["uri"] = uri; }), "plant.gltf");
}

}  // namespace
}  // namespace liana
