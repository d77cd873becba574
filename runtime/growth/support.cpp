#include "runtime/growth/support.h"

namespace liana {

std::optional<Support> closest_support(std::span<const SdfObstacle* const> obstacles, const Vec3& x, double radius) {
  std::optional<Support> best;
  for (const SdfObstacle* obstacle : obstacles) {
    const double limit = best ? best->distance : radius;
    if (obstacle->distance(x) > limit) continue;  // a lower bound far away
    const SurfacePoint found = obstacle->closest_point(x);
    if (found.distance > limit) continue;
    const Vec3 away = x - found.point;
    const bool touching = std::abs(found.distance) < 1e-9;
    best = {found.point, touching ? found.normal : Vec3(away / found.distance), found.distance};
  }
  return best;
}

}  // namespace liana
