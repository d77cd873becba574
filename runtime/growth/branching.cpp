#include "runtime/growth/branching.h"

#include <algorithm>

#include "mesher/base/random.h"
#include "runtime/sim/model/rotation.h"

namespace liana {

std::vector<Bud> breaking_buds(const Shoot& shoot, int level, const Vec3& node, const Vec3& forward,
                               const Vec3& outward, const BranchingParameters& parameters,
                               const Crowding& crowding, const Draws& draws) {
  std::vector<Bud> buds;
  if (level >= parameters.max_level) return buds;
  for (unsigned i = 0; i < parameters.max_laterals; ++i) {
    if (draws.uniform(3 * i) >= parameters.probability) continue;
    const double side = draws.uniform(3 * i + 1) < 0.5 ? -1 : 1;
    const double off = parameters.variance * kPi / 2 * draws.uniform(3 * i + 2, -1, 1);
    const double angle = side * (parameters.angle + off);
    const Vec3 direction = (rotation_about(outward, angle) * forward).normalized();
    if (crowding.crowded(node + 1.5 * parameters.room * direction, parameters.room, BranchId())) continue;
    buds.push_back(
        {i, direction, std::clamp(shoot.course + angle, -1.4, 1.4), shoot.tip_radius * parameters.falloff});
  }
  return buds;
}

}  // namespace liana
