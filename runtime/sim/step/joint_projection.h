// Joint projection, the last net: joints that no substep kept together are closed by moving their particles.
#pragma once

#include <span>

#include "runtime/sim/model/plant.h"

namespace liana {

/// From the root on: every particle whose joint is open by more than gap_limit (of its gap_scale()) is moved,
/// unturned, to where the joint is closed, and takes the joint's velocity. All else keeps its place relative
/// to its parent. The step gains no kinetic energy over its `start`; accelerations are forgotten. Returns how
/// many joints were closed.
int project_joints(Plant& plant, std::span<const Motion> start, double gap_limit);

}  // namespace liana
