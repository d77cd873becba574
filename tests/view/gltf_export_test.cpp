#include "runtime/export/gltf_export.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <filesystem>

#include "mesher/base/error.h"
#include "tests/support/plants/draw_plants.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct GltfExport : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("liana export " + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  tinygltf::Model written(const DrawScene& scene) {
    write_gltf(folder / "a.glb", scene);
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(
        tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, (folder / "a.glb").string()))
        << error;
    EXPECT_EQ(error + warning, "");
    return model;
  }
};

DrawScene plant_and_wall() {
  DrawScene scene;
  add_plant(support::forked_plant(), plant_look("ivy"), {.names = true}, scene);
  scene.leaves.push_back(scene.leaves[0]);
  scene.leaves[1].name.clear();
  scene.leaves[1].base += Vec3(0.3, 0, 0);
  scene.meshes.push_back({support::box_mesh({-1, 0, -0.2}, {1, 3, 0}), {0.4, 0.2, 0.1}, true, "wall"});
  return scene;
}

const tinygltf::Node& node_named(const tinygltf::Model& model, const std::string& name) {
  for (const tinygltf::Node& node : model.nodes)
    if (node.name == name) return node;
  throw std::runtime_error("no node " + name);
}

const tinygltf::Accessor& positions(const tinygltf::Model& model, const tinygltf::Node& node) {
  return model.accessors[model.meshes[node.mesh].primitives[0].attributes.at("POSITION")];
}

TEST_F(GltfExport, NodesAreNamedAndSizesAreMetres) {
  const tinygltf::Model model = written(plant_and_wall());
  ASSERT_EQ(model.nodes.size(), 5u);
  EXPECT_EQ(model.scenes[0].nodes.size(), 5u);
  const tinygltf::Accessor& wall = positions(model, node_named(model, "wall"));
  EXPECT_EQ(wall.minValues, (std::vector<double>{-1, 0, double(-0.2f)}));
  EXPECT_EQ(wall.maxValues, (std::vector<double>{1, 3, 0}));
  const tinygltf::Accessor& stem = positions(model, node_named(model, "forked branch 0"));
  EXPECT_NEAR(stem.maxValues[1], 1 + 0.01, 1e-3);  // 1 m and the round tip
  node_named(model, "leaf_1");                     // unnamed ones get a number
}

TEST_F(GltfExport, LeavesShareOneMeshAndKeepTheirPose) {
  const DrawScene scene = plant_and_wall();
  const tinygltf::Model model = written(scene);
  const tinygltf::Node &a = node_named(model, "forked leaf 2"), &b = node_named(model, "leaf_1");
  EXPECT_EQ(a.mesh, b.mesh);
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(a.translation[i], scene.leaves[0].base[i]);
  EXPECT_DOUBLE_EQ(a.rotation[3], scene.leaves[0].orientation.w());
  EXPECT_DOUBLE_EQ(a.scale[0], scene.leaves[0].width);
  EXPECT_DOUBLE_EQ(a.scale[1], scene.leaves[0].length);
  const tinygltf::Accessor& blade = positions(model, a);
  EXPECT_NEAR(blade.maxValues[0] - blade.minValues[0], 1, 1e-6);  // unit width
}

TEST_F(GltfExport, NormalsAreUnitAndIndicesInRange) {
  const tinygltf::Model model = written(plant_and_wall());
  for (const tinygltf::Mesh& mesh : model.meshes) {
    const tinygltf::Primitive& primitive = mesh.primitives[0];
    const auto bytes = [&](int accessor) {
      return model.buffers[0].data.data() +
             model.bufferViews[model.accessors[accessor].bufferView].byteOffset;
    };
    const tinygltf::Accessor& normals = model.accessors[primitive.attributes.at("NORMAL")];
    const auto* normal = reinterpret_cast<const float*>(bytes(primitive.attributes.at("NORMAL")));
    for (size_t i = 0; i < normals.count; ++i) EXPECT_NEAR(Eigen::Vector3f(normal + 3 * i).norm(), 1, 1e-4f);
    const auto* index = reinterpret_cast<const uint32_t*>(bytes(primitive.indices));
    for (size_t i = 0; i < model.accessors[primitive.indices].count; ++i) EXPECT_LT(index[i], normals.count);
  }
}

TEST_F(GltfExport, EmptySceneIsAUsageErrorAndLeavesNothing) {
  EXPECT_THROW(write_gltf(folder / "a.glb", {}), Error);
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace liana
