// write_instanced_plant: a .glb by hand, as write_plant gives every domain a mesh of its own.
#include <fmt/core.h>

#include <cmath>
#include <cstring>

#include "mesher/base/files.h"
#include "tests/support/plants/large_plants.h"

namespace liana {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void add_chunk(std::string& file, const char* type, std::string content, char padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  append(file, static_cast<uint32_t>(content.size()));
  file.append(type, 4);
  file += content;
}

/// Local transform of a part below its parent, as glTF's translation, rotation and scale.
std::string node_json(const InstancedPlant& plant, size_t index, const std::string& children) {
  const InstancedPlant::Part& part = plant.parts[index];
  const Affine3 up = part.parent.valid() ? plant.parts[part.parent.index()].place : Affine3::Identity();
  const Affine3 local = up.inverse() * part.place;
  const double scale = std::cbrt(local.linear().determinant());
  const Quat q(Mat3(local.linear() / scale));
  const Vec3 t = local.translation();
  const bool leaf = part.kind == DomainKind::Leaf;
  return fmt::format(
      R"({{"name":"{}","mesh":{},"translation":[{},{},{}],"rotation":[{},{},{},{}],"scale":[{},{},{}],)"
      R"("extras":{{"liana":{{"kind":"{}"{}}}}}{}}})",
      part.name, part.mesh, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), scale, scale, scale,
      leaf ? "leaf" : "branch", leaf ? fmt::format(R"(,"thickness":{})", part.thickness) : "",
      children.empty() ? "" : fmt::format(R"(,"children":[{}])", children));
}

}  // namespace

void write_instanced_plant(const InstancedPlant& plant, const std::filesystem::path& path) {
  std::string binary, views, accessors, meshes;
  const auto comma = [](const std::string& list) { return list.empty() ? "" : ","; };
  for (size_t m = 0; m < plant.meshes.size(); ++m) {
    const Mesh& mesh = plant.meshes[m];
    const size_t at = binary.size();
    Eigen::AlignedBox3f box;
    for (const Vec3& p : mesh.positions) {
      const Eigen::Vector3f f = p.cast<float>();
      box.extend(f);
      append(binary, f);
    }
    const size_t indices = binary.size();
    for (const Triangle& t : mesh.triangles) append(binary, t);
    views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}},{{"buffer":0,"byteOffset":{},)"
                         R"("byteLength":{}}})",
                         comma(views), at, indices - at, indices, binary.size() - indices);
    accessors += fmt::format(
        R"({}{{"bufferView":{},"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},)"
        R"({{"bufferView":{},"componentType":5125,"count":{},"type":"SCALAR"}})",
        comma(accessors), 2 * m, mesh.positions.size(), box.min().x(), box.min().y(), box.min().z(),
        box.max().x(), box.max().y(), box.max().z(), 2 * m + 1, 3 * mesh.triangles.size());
    meshes += fmt::format(R"({}{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{}}}]}})",
                          comma(meshes), 2 * m, 2 * m + 1);
  }
  std::string nodes, roots;
  std::vector<std::string> children(plant.parts.size());
  for (size_t i = 0; i < plant.parts.size(); ++i) {
    const DomainId parent = plant.parts[i].parent;
    std::string& list = parent.valid() ? children[parent.index()] : roots;
    list += comma(list) + std::to_string(i);
  }
  for (size_t i = 0; i < plant.parts.size(); ++i) nodes += comma(nodes) + node_json(plant, i, children[i]);
  const std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{}],)"
      R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})",
      roots, nodes, meshes, accessors, views, binary.size());

  std::string chunks;
  add_chunk(chunks, "JSON", json, ' ');
  add_chunk(chunks, "BIN\0", binary, '\0');
  std::string file = "glTF";
  append(file, uint32_t{2});
  append(file, static_cast<uint32_t>(12 + chunks.size()));
  write_file(path, file + chunks);
}

}  // namespace liana
