#include "runtime/growth/branching.h"

#include <algorithm>

#include "runtime/sim/model/rotation.h"

namespace liana {

std::vector<Bud> breaking_buds(const Shoot& shoot, int level, const Vec3& node, const Vec3& forward,
                               const Vec3& outward, const BranchingParameters& parameters,
                               const Crowding& crowding, Random& random) {
  std::vector<Bud> buds;
  if (level >= parameters.max_level) return buds;
  for (unsigned i = 0; i < parameters.max_laterals; ++i) {
    // Drawn whether needed or not, so that one bud's fate does not shift the numbers of the next.
    const bool breaks = random.uniform() < parameters.probability;
    const double side = random.uniform() < 0.5 ? -1 : 1;
    const double off = parameters.variance * kPi / 2 * random.uniform(-1, 1);
    if (!breaks) continue;
    const double angle = side * (parameters.angle + off);
    const Vec3 direction = (rotation_about(outward, angle) * forward).normalized();
    if (crowding.crowded(node + 1.5 * parameters.room * direction, parameters.room, BranchId())) continue;
    buds.push_back(
        {direction, std::clamp(shoot.course + angle, -1.4, 1.4), shoot.tip_radius * parameters.falloff});
  }
  return buds;
}

}  // namespace liana
