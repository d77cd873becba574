// One vertex per place.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Merges positions nearer than relative_tolerance times the diagonal of the bounding box, drops triangles
/// that lose a corner by it and vertices that no triangle uses. Vertices keep the order of their first use.
/// Indices must be valid and positions finite.
Mesh weld(const Mesh& mesh, double relative_tolerance = 1e-9);

/// Per position, the number of its place: positions within the tolerance (m) of a place share it. Places are
/// numbered from 0 in order of first appearance.
std::vector<uint32_t> find_places(const std::vector<Vec3>& positions, double tolerance,
                                  std::vector<Vec3>& places);

/// The same triangles without the vertices that none of them uses.
Mesh compacted(const Mesh& mesh);

}  // namespace liana
