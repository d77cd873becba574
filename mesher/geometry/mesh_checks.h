// What a triangle mesh is: its neighbourhood, borders, connected parts, area and volume.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Triangles across edges. Edge k of a triangle t runs from t[k] to t[(k + 1) % 3].
struct Adjacency {
  static constexpr uint32_t kNone = Id<Mesh>::kNone;
  std::vector<std::array<uint32_t, 3>> across;  ///< neighbour over each edge, kNone on the border
  bool manifold = true;                         ///< no edge has more than two triangles
  bool oriented = true;  ///< neighbours run along their common edge in opposite directions
  bool closed = true;    ///< every edge has two triangles
};

Adjacency find_adjacency(const Mesh& mesh);

/// Border loops of an oriented manifold: vertices in the direction of their triangles' edges (the surface to
/// the left, seen from outside). A vertex where two borders touch appears once in each visit.
std::vector<std::vector<uint32_t>> border_loops(const Mesh& mesh, const Adjacency& adjacency);

/// Per triangle, the number of its edge-connected part; parts are numbered from 0 in order of first triangle.
std::vector<uint32_t> connected_parts(const Adjacency& adjacency, uint32_t* count);

Vec3 area_vector(const Mesh& mesh,
                 const Triangle& triangle);  ///< m², half the cross product: area times normal
double surface_area(const Mesh& mesh);       ///< m²
double signed_volume(const Mesh& mesh);      ///< m³ of a closed mesh, positive if oriented outward

}  // namespace liana
