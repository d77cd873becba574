// Plants that nothing holds.
#pragma once

#include <span>

#include "runtime/sim/model/plant.h"

namespace liana {

/// The plant's roots have joints without stiffness or load.
bool is_free(const Plant& plant);

/// After a step of a free plant without mass damping on which nothing but gravity acts: joints exert no net
/// moment, but a step changes its angular momentum by a share of (ω h)². The plant is turned as a whole by
/// what is missing since `before`. Does nothing to any other plant.
void keep_angular_momentum(std::span<const Motion> before, Plant& plant);

}  // namespace liana
