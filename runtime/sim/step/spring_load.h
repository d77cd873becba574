// A WorldSpring as a substep sees it: a force on one particle, and a share of its 6×6 block.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// Adds a spring's force and stiffness to the block of its particle. position_rate, velocity_rate: k₁, k₂ of
/// the substep. pose, block: of the particle's slot, see step_view.h.
void add_spring(const WorldSpring& spring, double position_rate, double velocity_rate, const double* pose,
                double* block);

}  // namespace liana
