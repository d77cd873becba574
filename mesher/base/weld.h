// One vertex per place.
#pragma once

#include "mesher/base/mesh.h"

namespace liana {

/// Merges positions nearer than relative_tolerance times the diagonal of the bounding box, drops triangles
/// that lose a corner by it and vertices that no triangle uses. Vertices keep the order of their first use.
/// Indices must be valid and positions finite.
Mesh weld(const Mesh& mesh, double relative_tolerance = 1e-9);

/// The same triangles without the vertices that none of them uses.
Mesh compacted(const Mesh& mesh);

}  // namespace liana
