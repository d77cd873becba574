// The surface of a tet mesh.
#pragma once

#include <array>
#include <vector>

#include "mesher/tets/tet_mesh.h"

namespace liana {

/// Faces that belong to one tet only, their corners counter-clockwise seen from outside.
std::vector<std::array<uint32_t, 3>> boundary_faces(const TetMesh& mesh);

}  // namespace liana
