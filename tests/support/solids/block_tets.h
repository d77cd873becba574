// Structured tet meshes of blocks, for solids whose modes are known in closed form.
#pragma once

#include <functional>

#include "mesher/tets/tet_mesh.h"

namespace liana {

/// nx × ny × nz cells of the unit cube, six tets each (mirrored from cell to cell), every vertex moved by
/// `map`, which must keep the orientation. root_faces are those that lay on x = 0.
TetMesh make_block(int nx, int ny, int nz, const std::function<Vec3(const Vec3&)>& map);

/// Every tet split into eight of half the size; root faces into four.
TetMesh refined(const TetMesh& mesh);

}  // namespace liana
