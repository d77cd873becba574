#include "runtime/export/gltf_export.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <optional>
#include <sstream>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "runtime/export/gltf_builder.h"
#include "runtime/picture/leaf_mesh.h"
#include "runtime/picture/smooth_normals.h"
#include "runtime/picture/tube_mesh.h"

namespace liana {
namespace {

std::string named(const std::string& name, const char* kind, size_t index) {
  return name.empty() ? fmt::format("{}_{}", kind, index) : name;
}

GltfSurface tube_surface(const DrawTube& tube, int sides) {
  TubeMesh mesh;
  append_tube(tube, sides, mesh);
  GltfSurface surface;
  for (const TubeVertex& vertex : mesh.vertices) {
    surface.positions.emplace_back(vertex.position.x, vertex.position.y, vertex.position.z);
    surface.normals.emplace_back(vertex.normal.x, vertex.normal.y, vertex.normal.z);
  }
  surface.triangles = std::move(mesh.triangles);
  return surface;
}

/// Vertices are split at corners, so that edges stay sharp.
GltfSurface split_surface(const Mesh& mesh) {
  const std::vector<Vec3> normals = corner_normals(mesh);
  GltfSurface surface;
  for (uint32_t corner = 0; corner < normals.size(); ++corner) {
    surface.positions.push_back(mesh.positions[mesh.triangles[corner / 3][corner % 3]].cast<float>());
    surface.normals.push_back(normals[corner].cast<float>());
    if (corner % 3 == 2) surface.triangles.push_back({corner - 2, corner - 1, corner});
  }
  return surface;
}

/// A blade of unit length and width; a node's scale makes it a leaf.
GltfSurface blade_surface(LeafOutline outline, double curl) {
  DrawLeaf unit;
  unit.length = unit.width = 1;
  unit.curl = curl;
  const LeafShape& shape = leaf_shape(outline);
  Mesh mesh;
  for (const glm::vec2& point : shape.points) mesh.positions.push_back(blade_point(unit, point));
  mesh.triangles = shape.triangles;
  return split_surface(mesh);
}

void add_leaves(const DrawScene& scene, GltfBuilder& builder, tinygltf::Model& model) {
  for (int outline = 0; outline < kLeafOutlineCount; ++outline) {
    Vec3 color = Vec3::Zero();
    double curl = 0;
    size_t count = 0;
    for (const DrawLeaf& leaf : scene.leaves)
      if (int(leaf.outline) == outline) color += leaf.color, curl += leaf.curl, ++count;
    if (count == 0) continue;
    const int mesh = builder.mesh(outline == int(LeafOutline::Ivy) ? "ivy blade" : "ovate blade",
                                  blade_surface(LeafOutline(outline), curl / double(count)),
                                  builder.material(color / double(count), 0.5, true));
    for (size_t i = 0; i < scene.leaves.size(); ++i) {
      const DrawLeaf& leaf = scene.leaves[i];
      if (int(leaf.outline) != outline) continue;
      tinygltf::Node& node = model.nodes[size_t(builder.node(named(leaf.name, "leaf", i), mesh))];
      const Quat q = leaf.orientation.normalized();
      node.translation = {leaf.base.x(), leaf.base.y(), leaf.base.z()};
      node.rotation = {q.x(), q.y(), q.z(), q.w()};
      node.scale = {leaf.width, leaf.length, leaf.length};
    }
  }
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const DrawScene& scene, const GltfExportOptions& options) {
  tinygltf::Model model;
  GltfBuilder builder(model);
  for (size_t i = 0; i < scene.tubes.size(); ++i) {
    const GltfSurface surface = tube_surface(scene.tubes[i], options.tube_sides);
    if (surface.triangles.empty()) continue;  // shorter than a micrometre
    const std::string name = named(scene.tubes[i].name, "branch", i);
    builder.node(name, builder.mesh(name, surface, builder.material(scene.tubes[i].color, 0.85, false)));
  }
  add_leaves(scene, builder, model);
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    if (scene.meshes[i].mesh.triangles.empty()) continue;
    const std::string name = named(scene.meshes[i].name, "obstacle", i);
    const int material = builder.material(scene.meshes[i].color, 0.95, false);
    builder.node(name, builder.mesh(name, split_surface(scene.meshes[i].mesh), material));
  }
  if (model.nodes.empty())
    throw Error(Error::Kind::Usage, path.string() + ": there is nothing in the scene to export");

  std::ostringstream bytes;
  tinygltf::TinyGLTF writer;
  require(writer.WriteGltfSceneToStream(&model, bytes, false, true), "glTF writing failed");
  write_file(path, bytes.str());
}

}  // namespace liana
