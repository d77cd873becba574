// How a growing tip turns: rotations of its forward direction, as functions of directions only.
//
// Symbols ([Haedrich17] §4.2): v̂_f forward, v̂_s towards the closest surface, v̂_l towards the light (all unit,
// world); τ, η strengths (rad/s); O occlusion in [0, 1]; Δt growth time (s).
#pragma once

#include "mesher/base/types.h"

namespace liana {

/// Eq. 6: a tip that faces the surface or leaves it turns to lie along it: by (v̂_s·v̂_f - lean) τΔt about v̂_s
/// × v̂_f. `lean` is the v̂_s·v̂_f that it comes to rest at: 0 as in the paper, more to approach a surface, less
/// to leave it. Never turns past it. A tip that faces the surface squarely turns about `fallback_axis`.
Quat surface_adaption(const Vec3& forward, const Vec3& to_surface, double lean, double tau_dt,
                      const Vec3& fallback_axis);

/// Eq. 7: turns towards the light by (1 - O) η Δt, never past it. The paper prints the axis v̂_l × v̂_f, which
/// would turn away from the light; it is v̂_f × v̂_l.
Quat phototropism(const Vec3& forward, const Vec3& to_light, double occlusion, double eta_dt);

/// Turns towards a course by rate·Δt·sin of the angle to it, never past it.
Quat steering(const Vec3& forward, const Vec3& course, double rate_dt);

}  // namespace liana
