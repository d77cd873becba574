// Shading normals of a triangle mesh: smooth where it is smooth, sharp at its edges.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// One unit normal per triangle corner (3 per triangle): the area-weighted mean of the faces around the
/// corner's position that turn less than 40 degrees from the corner's own face. Positions are matched
/// exactly, so vertices that a file has split still smooth together.
std::vector<Vec3> corner_normals(const Mesh& mesh);

}  // namespace liana
