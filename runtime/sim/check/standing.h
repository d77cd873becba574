// Does a plant stand under its own weight?
#pragma once

#include "mesher/base/progress.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct Standing {
  double moved = 0;  ///< m, the farthest any particle went in 10 s at rest
  bool stable =
      true;  ///< false when a push of a thousandth of g grows instead of dying away: the plant topples
};

/// Steps a copy of the plant under gravity (m/s²): 10 s untouched, then 20 s after a push of 1 s. A plant
/// that is too soft for its height or its branches is in equilibrium as modelled, but does not stay there.
/// Throws Error{Cancelled}.
Standing check_standing(Plant plant, Progress& progress, const Vec3& gravity = {0, -9.81, 0});

}  // namespace liana
