// What a triangle mesh is: its neighbourhood, borders, connected parts, area and volume.
#pragma once

#include <span>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Triangles across edges. Edge k of a triangle t runs from t[k] to t[(k + 1) % 3].
struct Adjacency {
  static constexpr uint32_t kNone = Id<Mesh>::kNone;
  std::vector<std::array<uint32_t, 3>> across;  ///< neighbour over each edge, kNone on the border
  std::vector<std::array<uint8_t, 3>> crowded;  ///< 1 on edges of more than two; empty if there is none
  bool manifold = true;                         ///< no edge has more than two triangles
  bool oriented = true;  ///< neighbours run along their common edge in opposite directions
  bool closed = true;    ///< every edge has two triangles
};

Adjacency find_adjacency(const Mesh& mesh);

/// Border loops, as HalfEdgeMesh finds them: vertices in the direction of their triangles' edges (the surface
/// to the left, seen from outside). A vertex where two borders touch is in both.
std::vector<std::vector<uint32_t>> border_loops(const Mesh& mesh, const Adjacency& adjacency);

/// Per triangle, the number of its edge-connected part; parts are numbered from 0 in order of first triangle.
std::vector<uint32_t> connected_parts(const Adjacency& adjacency, uint32_t* count);

std::vector<Eigen::AlignedBox3d> triangle_boxes(const Mesh& mesh);

/// The triangles around every vertex, ascending.
class VertexTriangles {
 public:
  VertexTriangles() = default;
  explicit VertexTriangles(const Mesh& mesh);
  std::span<const uint32_t> of(uint32_t vertex) const {
    return std::span(around_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }

 private:
  std::vector<uint32_t> first_, around_;
};

Vec3 area_vector(const Mesh& mesh,
                 const Triangle& triangle);  ///< m², half the cross product: area times normal
double surface_area(const Mesh& mesh);       ///< m²
double signed_volume(const Mesh& mesh);      ///< m³ of a closed mesh, positive if oriented outward

}  // namespace liana
