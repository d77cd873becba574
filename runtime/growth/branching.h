// Lateral shoots: whether a bud breaks at a node, and where its shoot goes.
#pragma once

#include <vector>

#include "mesher/base/random.h"
#include "runtime/growth/crowding.h"
#include "runtime/growth/shoot_growth.h"

namespace liana {

struct Bud {
  unsigned ordinal;   ///< at its node
  Vec3 direction;     ///< unit, world
  double course;      ///< rad, of the new shoot
  double tip_radius;  ///< m: t_c = t_p f
};

/// The buds that break at the head of a full-grown particle: at most max_laterals, each with the given
/// probability and direction variance ([Haedrich17] §4.3), and only where there is room. `outward` is away
/// from the support; `draws` are the node's.
std::vector<Bud> breaking_buds(const Shoot& shoot, int level, const Vec3& node, const Vec3& forward,
                               const Vec3& outward, const BranchingParameters& parameters,
                               const Crowding& crowding, const Draws& draws);

}  // namespace liana
