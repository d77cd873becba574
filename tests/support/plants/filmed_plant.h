// A trunk with three branches in the plane of a picture, of known material, to be filmed.
#pragma once

#include <string>

#include "tests/support/plants/synthetic_bake.h"

namespace liana::test {

/// ν = 1.1 Hz (ℓ / 2 m)^−0.59 for the trunk, 2.4 Hz (ℓ / 0.7 m)^−0.59 for the branches; ξ 0.03 and 0.05. The
/// branches are light, so that each swings as if its parent were held (to 1 %).
Bake filmed_plant();

/// Without weight, which would lower the frequency of what stands upright: the law is the material's own.
inline const std::string kFilmedScene =
    "time_step = 0.02\n"  // two steps a frame of the video
    "gravity = [0, 0, 0]\n"
    "[camera]\neye = [0, 1.1, 3.6]\ntarget = [0, 1.1, 0]\nvertical_angle = 38\n"
    "[[plant]]\nbake = \"plant.bake\"\n";

/// The trunk and every branch are struck after one second and let go.
inline const std::string kImpulses =
    "[[pluck]]\ndomain = \"trunk\"\ntime = 1\nvelocity = [0.4, 0, 0]\n"
    "[[pluck]]\ndomain = \"left\"\ntime = 1\nvelocity = [0.6, 1.0, 0]\n"
    "[[pluck]]\ndomain = \"right\"\ntime = 1\nvelocity = [0.6, -1.0, 0]\n"
    "[[pluck]]\ndomain = \"top\"\ntime = 1\nvelocity = [-0.9, -0.9, 0]\n";

}  // namespace liana::test
