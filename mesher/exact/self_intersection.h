// Whether a surface passes through itself. The only file that sees CGAL.
#pragma once

#include "mesher/geometry/mesh.h"

namespace liana {

/// True if two triangles meet anywhere but in a shared vertex or edge, if a triangle has no area, or if the
/// mesh is not a consistently oriented manifold (open or closed). Exact predicates; 1-2 ms per 1,000
/// triangles.
bool self_intersects(const Mesh& mesh);

}  // namespace liana
