// An indexed triangle mesh.
#pragma once

#include <array>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

using Triangle = std::array<uint32_t, 3>;

/// Triangles wind counter-clockwise seen from outside.
struct Mesh {
  std::vector<Vec3> positions;  ///< m
  std::vector<Triangle> triangles;
};

}  // namespace liana
