// Surfaces taken apart where they only touch: every fan of triangles gets a vertex of its own.
#pragma once

#include <vector>

#include "mesher/geometry/mesh_checks.h"

namespace liana {

/// Triangles whose corners are fans: the triangles at a vertex that hang together over edges there.
struct Fans {
  std::vector<Triangle> triangles;  ///< the mesh's, with the numbers of their fans for vertices
  std::vector<uint32_t> vertex;     ///< per fan, the mesh's vertex it is at
};

/// The first fan at a vertex keeps the vertex's number, the others get new ones behind all vertices, in
/// order of their first triangle. `across` says over which edges triangles hang together.
Fans separate_fans(const Mesh& mesh, const Adjacency& adjacency);

/// Every directed edge once, and the triangles around a vertex one fan (or, on the border, one open fan).
bool is_oriented_manifold(const Mesh& mesh);

}  // namespace liana
