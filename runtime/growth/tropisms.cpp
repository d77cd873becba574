#include "runtime/growth/tropisms.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/model/rotation.h"

namespace liana {
namespace {

/// By `angle` about the direction of `axis`; the identity when it has none.
Quat turn(const Vec3& axis, double angle) {
  const double length = axis.norm();
  if (length < 1e-12) return Quat::Identity();
  return rotation_about(axis / length, angle);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return fixed::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

// A positive angle about v̂_s × v̂_f carries v̂_f further from v̂_s: the sign in Eq. 6 is right.
Quat surface_adaption(const Vec3& forward, const Vec3& to_surface, double lean, double tau_dt,
                      const Vec3& fallback_axis) {
  const Vec3 axis = to_surface.cross(forward);
  const double to_rest = fixed::acos(std::clamp(lean, -1.0, 1.0)) - angle_between(to_surface, forward);
  const double angle = (to_surface.dot(forward) - lean) * tau_dt;
  const double limited = std::copysign(std::min(std::abs(angle), std::abs(to_rest)), to_rest);
  return turn(axis.norm() > 1e-6 ? axis : fallback_axis, limited);
}

Quat phototropism(const Vec3& forward, const Vec3& to_light, double occlusion, double eta_dt) {
  const double angle = std::min((1 - occlusion) * eta_dt, angle_between(forward, to_light));
  return turn(forward.cross(to_light), angle);
}

Quat steering(const Vec3& forward, const Vec3& course, double rate_dt) {
  const Vec3 axis = forward.cross(course);
  return turn(axis, std::min(rate_dt * axis.norm(), angle_between(forward, course)));
}

}  // namespace liana
