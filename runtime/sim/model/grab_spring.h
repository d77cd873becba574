// The spring with which a user, or a scene, holds a plant at a point.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// `strength` 1: the whole plant's weight stretches it by 2 cm. Damped over two time steps, so that the jerks
/// of a hand are not felt. Its target is where the point is now. `gravity` in m/s²; where there is none, the
/// spring is that of a plant on Earth. `time_step` in s.
WorldSpring grab_spring(const Plant& plant, ParticleId particle, const Vec3& on_particle, const Vec3& gravity,
                        double time_step, double strength = 1);

}  // namespace liana
