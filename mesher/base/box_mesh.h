// An axis-aligned box as a closed mesh.
#pragma once

#include "mesher/base/mesh.h"

namespace liana {

/// 8 vertices, 12 triangles, outward.
inline Mesh box_mesh(const Vec3& centre, const Vec3& size) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back(
        centre + 0.5 * size.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

}  // namespace liana
