// The pieces of a glTF model that hold geometry: buffer, accessors, materials, meshes.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace tinygltf {
class Model;
}

namespace liana {

/// A surface as a file holds it: one normal per position, 32-bit floats.
struct GltfSurface {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Triangle> triangles;
};

class GltfBuilder {
 public:
  explicit GltfBuilder(tinygltf::Model& model);

  /// Index of the material of this colour (linear RGB, rounded to 1/32 in square root so that near shades
  /// share one).
  int material(const Vec3& color, double roughness, bool double_sided);
  int mesh(const std::string& name, const GltfSurface& surface, int material);
  /// A node of the scene; returns its index.
  int node(const std::string& name, int mesh);

 private:
  int accessor(const void* data, size_t bytes, int type, int component, size_t count, int target);

  tinygltf::Model& model_;
  std::vector<std::pair<std::array<int, 5>, int>> materials_;
};

}  // namespace liana
