#include "runtime/picture/air_drawing.h"

#include <algorithm>

namespace liana {

void add_air(const SphAir& air, DrawScene& scene) {
  constexpr double kWay = 0.02;  // s
  const Vec3 slow(0.02, 0.10, 0.45), fast(1.0, 0.98, 0.90);
  double top = 1e-6;
  for (size_t i = 0; i < air.size(); ++i) top = std::max(top, air.velocity(i).norm());
  for (size_t i = 0; i < air.size(); ++i) {
    const Vec3 place = air.position(i), velocity = air.velocity(i);
    const double share = velocity.norm() / top;
    scene.streaks.push_back(
        {place - kWay * velocity, place, slow + share * (fast - slow), 0.35 + 0.4 * share});
  }
}

}  // namespace liana
