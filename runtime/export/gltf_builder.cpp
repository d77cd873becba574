#include "runtime/export/gltf_builder.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

namespace liana {

GltfBuilder::GltfBuilder(tinygltf::Model& model) : model_(model) {
  model_.asset.version = "2.0";
  model_.asset.generator = "liana";
  model_.buffers.resize(1);
  model_.scenes.resize(1);
  model_.defaultScene = 0;
}

int GltfBuilder::material(const Vec3& color, double roughness, bool double_sided) {
  std::array<int, 5> key{};
  for (int i = 0; i < 3; ++i) key[i] = int(std::lround(32 * std::sqrt(std::clamp(color[i], 0.0, 1.0))));
  key[3] = int(std::lround(100 * roughness));
  key[4] = double_sided;
  const auto known =
      std::find_if(materials_.begin(), materials_.end(), [&](const auto& m) { return m.first == key; });
  if (known != materials_.end()) return known->second;
  tinygltf::Material made;
  made.name = (double_sided ? "leaf " : "surface ") + std::to_string(materials_.size());
  made.doubleSided = double_sided;
  const auto level = [&](int i) { return (key[i] / 32.0) * (key[i] / 32.0); };
  made.pbrMetallicRoughness.baseColorFactor = {level(0), level(1), level(2), 1};
  made.pbrMetallicRoughness.metallicFactor = 0;
  made.pbrMetallicRoughness.roughnessFactor = roughness;
  model_.materials.push_back(made);
  materials_.emplace_back(key, int(model_.materials.size() - 1));
  return materials_.back().second;
}

int GltfBuilder::accessor(const void* data, size_t bytes, int type, int component, size_t count, int target) {
  std::vector<unsigned char>& buffer = model_.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = bytes;
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(data);
  buffer.insert(buffer.end(), first, first + bytes);  // all components are 4 bytes: views stay aligned
  model_.bufferViews.push_back(view);
  tinygltf::Accessor made;
  made.bufferView = int(model_.bufferViews.size() - 1);
  made.componentType = component;
  made.count = count;
  made.type = type;
  model_.accessors.push_back(made);
  return int(model_.accessors.size() - 1);
}

int GltfBuilder::mesh(const std::string& name, const GltfSurface& surface, int material) {
  const size_t count = surface.positions.size(), bytes = count * sizeof(Eigen::Vector3f);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = material;
  const auto vectors = [&](const std::vector<Eigen::Vector3f>& values) {
    return accessor(values.data(), bytes, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, count,
                    TINYGLTF_TARGET_ARRAY_BUFFER);
  };
  const int positions = vectors(surface.positions);
  Eigen::Vector3f low = surface.positions[0], high = low;
  for (const Eigen::Vector3f& p : surface.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  model_.accessors[positions].minValues = {low.x(), low.y(), low.z()};
  model_.accessors[positions].maxValues = {high.x(), high.y(), high.z()};
  primitive.attributes = {{"POSITION", positions}, {"NORMAL", vectors(surface.normals)}};
  primitive.indices = accessor(surface.triangles.data(), surface.triangles.size() * sizeof(Triangle),
                               TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                               3 * surface.triangles.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh made;
  made.name = name;
  made.primitives = {primitive};
  model_.meshes.push_back(made);
  return int(model_.meshes.size() - 1);
}

int GltfBuilder::node(const std::string& name, int mesh) {
  tinygltf::Node made;
  made.name = name;
  made.mesh = mesh;
  model_.nodes.push_back(made);
  model_.scenes[0].nodes.push_back(int(model_.nodes.size() - 1));
  return model_.scenes[0].nodes.back();
}

}  // namespace liana
