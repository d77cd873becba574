#include "runtime/growth/surroundings.h"

#include <algorithm>
#include <cmath>

namespace liana {

std::optional<Support> closest_support(std::span<const SdfObstacle* const> obstacles, const Vec3& x,
                                       double radius) {
  std::optional<Support> best;
  for (const SdfObstacle* obstacle : obstacles) {
    const double limit = best ? best->distance : radius;
    if (obstacle->distance(x) > limit) continue;  // a lower bound far away
    const SurfacePoint found = obstacle->closest_point(x);
    if (found.distance > limit) continue;
    const Vec3 away = x - found.point;
    const bool touching = std::abs(found.distance) < 1e-9;
    best = {found.point, touching ? found.normal : Vec3(away / found.distance), found.distance, obstacle};
  }
  return best;
}

Vec3 way_out(const Vec3& centre, double radius, const Surroundings& around) {
  double deepest = std::min(0.0, centre.y() - around.ground_height - radius);
  Vec3 way = -deepest * Vec3::UnitY();
  for (const SdfObstacle* obstacle : around.obstacles) {
    if (obstacle->distance(centre) >= radius + deepest) continue;
    const SurfacePoint closest = obstacle->closest_point(centre);
    const double gap = closest.distance - radius;
    if (gap >= deepest) continue;
    deepest = gap;
    const bool touching = std::abs(closest.distance) < 1e-9;
    way = -gap * (touching ? closest.normal : Vec3((centre - closest.point) / closest.distance));
  }
  return way;
}

}  // namespace liana
