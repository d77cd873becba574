// A plant that stands as it was modelled: what its joints carry at rest.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// Sets every joint's rest load so that the plant, exactly in its present pose, is in equilibrium under
/// gravity (m/s²): weights and moments summed from leaves to root. Call after calibration. Anchors are taken
/// to carry nothing. A plant too soft for its height is in equilibrium all the same, but not a stable one: it
/// topples, as in nature.
void carry_weight(Plant& plant, const Vec3& gravity = {0, -9.81, 0});

}  // namespace liana
