// write_plant: domains become nodes.
#include <tiny_gltf.h>

#include <algorithm>
#include <sstream>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/io/plant_file.h"

namespace liana {
namespace {

/// Appends values to the buffer and describes them by a buffer view; returns the view's index.
template <class T>
int append(tinygltf::Model& model, const std::vector<T>& values, int target) {
  std::vector<unsigned char>& bytes = model.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = values.size() * sizeof(T);
  view.target = target;
  const auto* first = reinterpret_cast<const unsigned char*>(values.data());
  bytes.insert(bytes.end(), first, first + view.byteLength);
  model.bufferViews.push_back(view);
  return static_cast<int>(model.bufferViews.size() - 1);
}

int add_accessor(tinygltf::Model& model, int view, size_t count, int type, int component) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.count = count;
  accessor.type = type;
  accessor.componentType = component;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size() - 1);
}

/// Positions are stored as floats relative to `origin`.
int add_mesh(tinygltf::Model& model, const Domain& domain, const Vec3& origin) {
  std::vector<float> positions;
  Eigen::AlignedBox3f box;
  for (const Vec3& p : domain.surface.positions) {
    const Eigen::Vector3f local = (p - origin).cast<float>();
    box.extend(local);
    positions.insert(positions.end(), local.data(), local.data() + 3);
  }
  std::vector<uint32_t> indices;
  for (const Triangle& t : domain.surface.triangles) indices.insert(indices.end(), t.begin(), t.end());

  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = domain.kind == DomainKind::Leaf;
  const int position_view = append(model, positions, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["POSITION"] = add_accessor(model, position_view, domain.surface.positions.size(),
                                                  TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT);
  tinygltf::Accessor& accessor = model.accessors.back();
  accessor.minValues = {box.min().x(), box.min().y(), box.min().z()};
  accessor.maxValues = {box.max().x(), box.max().y(), box.max().z()};
  const int index_view = append(model, indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  primitive.indices = add_accessor(model, index_view, indices.size(), TINYGLTF_TYPE_SCALAR,
                                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
  tinygltf::Mesh mesh;
  mesh.name = domain.name;
  mesh.primitives.push_back(primitive);
  model.meshes.push_back(mesh);
  return static_cast<int>(model.meshes.size() - 1);
}

tinygltf::Value extras_of(const Domain& domain) {
  tinygltf::Value::Object liana;
  liana["kind"] = tinygltf::Value(std::string(domain.kind == DomainKind::Leaf ? "leaf" : "branch"));
  liana["group"] = tinygltf::Value(domain.group);
  if (domain.kind == DomainKind::Leaf) liana["thickness"] = tinygltf::Value(domain.thickness);
  return tinygltf::Value(tinygltf::Value::Object{{"liana", tinygltf::Value(liana)}});
}

tinygltf::Material material(const char* name, std::vector<double> colour, bool double_sided) {
  tinygltf::Material result;
  result.name = name;
  result.doubleSided = double_sided;
  result.pbrMetallicRoughness.baseColorFactor = std::move(colour);
  result.pbrMetallicRoughness.metallicFactor = 0;
  result.pbrMetallicRoughness.roughnessFactor = 0.8;
  return result;
}

}  // namespace

void write_plant(const SegmentedPlant& plant, const std::filesystem::path& path) {
  require(!plant.domains.empty(), "write_plant: a plant has at least one domain");
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "liana";
  model.materials = {material("bark", {0.30, 0.22, 0.15, 1}, false),
                     material("leaf", {0.13, 0.33, 0.08, 1}, true)};
  model.buffers.resize(1);
  model.scenes.resize(1);
  model.defaultScene = 0;
  model.nodes.resize(plant.domains.size());
  std::vector<Vec3> origins;
  for (size_t i = 0; i < plant.domains.size(); ++i) {
    const Domain& domain = plant.domains[i];
    require(!domain.parent.valid() || domain.parent.index() < i, "write_plant: parents come before children");
    require(!domain.surface.triangles.empty(), "write_plant: a domain has a surface");
    Eigen::AlignedBox3d box;
    for (const Vec3& p : domain.surface.positions) box.extend(p);
    origins.push_back(box.center());
    const Vec3 offset =
        domain.parent.valid() ? Vec3(origins[i] - origins[domain.parent.index()]) : origins[i];
    tinygltf::Node& node = model.nodes[i];
    node.name = domain.name;
    node.translation = {offset.x(), offset.y(), offset.z()};
    node.mesh = add_mesh(model, domain, origins[i]);
    node.extras = extras_of(domain);
    (domain.parent.valid() ? model.nodes[domain.parent.index()].children : model.scenes[0].nodes)
        .push_back(static_cast<int>(i));
  }
  std::ostringstream out;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, out, true, path.extension() != ".gltf"))
    throw Error(Error::Kind::Output, path.string() + ": the plant cannot be written as glTF");
  write_file(path, out.str());
}

}  // namespace liana
