// One iso-line of the distance from the root, cut into a surface.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// A surface with the distance from its root at every vertex and marks on its triangles.
struct MarkedSurface {
  Mesh mesh;
  std::vector<double> distance;  ///< m, per vertex
  std::vector<uint8_t> is_root;  ///< per triangle
};

/// Splits the triangles that the line distance = level crosses; vertices within `snap` (m) of it count as on
/// it. New vertices lie on edges, so the shape stays. On an edge that is no crease, but the diagonal of a
/// flat face, none is needed: a ring around a six-sided branch gets six vertices. Vertices may be left
/// unused.
void cut_along(MarkedSurface& surface, double level, double snap);

}  // namespace liana
