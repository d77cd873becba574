// Small damage of a surface put right without changing its shape.
#pragma once

#include <string>

#include "mesher/geometry/mesh.h"

namespace liana {

struct Mended {
  Mesh mesh;
  double dropped = 0;         ///< share of the area that went with fins and inner walls
  double dropped_volume = 0;  ///< m³ between those and their rims: none for what is flat
  std::string notes;          ///< what was done, each with a leading "+"; empty if nothing was to do
};

/// - Slits: a border vertex next to another border edge (a T-junction, a crack) becomes part of it, if it is
///   nearer than 2 % of that edge.
/// - Fins and inner walls: where three or more triangles share an edge, the smallest patch between such edges
///   goes, until none is left or the smallest is an eighth of the surface.
/// - Pinches: a vertex where two fans of triangles touch becomes two, moved apart by 1e-3 of their edges.
/// The triangles may be wound either way.
Mended mend(const Mesh& welded);

}  // namespace liana
