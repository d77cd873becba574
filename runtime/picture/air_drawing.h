// Air particles -> streaks that end where a particle is and show where it came from.
#pragma once

#include "runtime/picture/draw_scene.h"
#include "runtime/wind/air/sph_air.h"

namespace liana {

/// Appends a streak per particle, as long as its way in 20 ms; slow air is blue, fast air white.
void add_air(const SphAir& air, DrawScene& scene);

}  // namespace liana
