// A mesh of straight-sided tetrahedra.
#pragma once

#include <array>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

/// Positively oriented: det(b-a, c-a, d-a) > 0 for every tet (a, b, c, d).
struct TetMesh {
  std::vector<Vec3> positions;  ///< m
  std::vector<std::array<uint32_t, 4>> tets;
  std::vector<std::array<uint32_t, 3>> root_faces;  ///< boundary faces that are held (the root interface)
  bool polished = false;  ///< slivers were only to be avoided by inserted points (ten times the time)
};

}  // namespace liana
