// What a growing part feels of the world: the closest support over all obstacles, the way out of solids, the
// sun.
#pragma once

#include <optional>
#include <span>

#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {

struct Support {
  Vec3 point;       ///< m, on the surface
  Vec3 normal;      ///< unit, from the surface to the place asked for (outwards when it is inside)
  double distance;  ///< m, negative inside
  const SdfObstacle* solid = nullptr;  ///< whose surface; null: the ground's
};

/// Exact. Nothing when no surface is within `radius` (m).
std::optional<Support> closest_support(std::span<const SdfObstacle* const> obstacles, const Vec3& x,
                                       double radius);

struct Surroundings {
  std::span<const SdfObstacle* const> obstacles;
  Vec3 to_sun;           ///< unit
  double ground_height;  ///< m
};

/// How a ball (m) must move to be outside every solid and the ground, as far as the deepest one asks; zero if
/// it is.
Vec3 way_out(const Vec3& centre, double radius, const Surroundings& around);

}  // namespace liana
