// The mass of what hangs on a solid, lumped on its vertices.
#pragma once

#include <span>
#include <vector>

#include "mesher/tets/tet_mesh.h"

namespace liana {

/// The mass of everything that hangs on the domain at one place, lumped on the vertices nearest to it.
struct CarriedMass {
  Vec3 position;  ///< m
  double mass;    ///< kg
};

struct NodeMass {
  uint32_t node;
  double mass;  ///< kg
};

/// Each mass goes to the three corners of the boundary face nearest to it, in the proportions of the nearest
/// point's barycentric coordinates: the total mass and, for a place on the surface, its centre are kept, and
/// three nodes across a face are no needle that could indent the solid at one. ([Wang17]: the modal mass
/// matrix carries the children's mass lumped on the interface.)
std::vector<NodeMass> lump(const TetMesh& mesh, std::span<const CarriedMass> carried);

}  // namespace liana
