// Distances along a surface.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Length of the shortest path along the surface from the nearest source vertex to every vertex, m. The front
/// is carried across triangles, as a circle where it comes from one source and as a line where it comes from
/// several: within 1 % of the exact distance on the surfaces of plants. Unreached vertices get infinity.
std::vector<double> geodesic_distance(const Mesh& mesh, const std::vector<uint8_t>& is_source);

}  // namespace liana
