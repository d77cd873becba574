// Obstacles that stand still and touch become one, so that the faces between them are no way out.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"
#include "runtime/obstacles/contact_material.h"

namespace liana {

struct StandingSolid {
  Mesh mesh;  ///< closed, outward
  ContactMaterial material;
  double voxel = 0;  ///< m, of its distance field; 0: as its shape suggests
};

/// Replaces solids of one contact material that overlap, or are nearer than a fifth of a millimetre to each
/// other, by their union, which is larger by a tenth of a millimetre. A solid stays by itself when it passes
/// through itself, has more than 20,000 triangles, or is much finer than the union's distance field would be.
void unite_touching(std::vector<StandingSolid>& solids);

}  // namespace liana
