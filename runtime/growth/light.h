// Light at a place: a fixed sun, shaded by obstacles. A plant does not shade itself yet.
#pragma once

#include <span>

#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {

/// O of [Haedrich17] Eq. 7: 1 where an obstacle stands between the point and the sun, else 0. to_sun is unit.
inline double occlusion(std::span<const SdfObstacle* const> obstacles, const Vec3& x, const Vec3& to_sun) {
  for (const SdfObstacle* obstacle : obstacles)
    if (obstacle->shades(x, to_sun)) return 1;
  return 0;
}

}  // namespace liana
