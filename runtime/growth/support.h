// The closest support of a plant part, over all obstacles.
#pragma once

#include <optional>
#include <span>

#include "runtime/sim/collision/sdf_obstacle.h"

namespace liana {

struct Support {
  Vec3 point;       ///< m, on the surface
  Vec3 normal;      ///< unit, from the surface to the place asked for (outwards when it is inside)
  double distance;  ///< m, negative inside
};

/// Exact. Nothing when no surface is within `radius` (m).
std::optional<Support> closest_support(std::span<const SdfObstacle* const> obstacles, const Vec3& x, double radius);

}  // namespace liana
