// Rotation vectors: the few formulas that joints and the time step share.
#pragma once

#include <cmath>

#include "mesher/base/fixed_math.h"
#include "mesher/base/types.h"

namespace liana {

/// [v]×: skew(v) w = v × w.
inline Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The rotation by `angle` (rad) about a unit axis.
inline Quat rotation_about(const Vec3& axis, double angle) {
  const double s = fixed::sin(angle / 2);
  return {fixed::cos(angle / 2), s * axis.x(), s * axis.y(), s * axis.z()};
}

/// The rotation by |v| radians about v. Unit to rounding.
inline Quat rotation_exp(const Vec3& v) {
  const double x = v.squaredNorm() / 4;  // half the angle, squared
  double c, s;                           // cos(angle/2), sin(angle/2)/angle
  if (x < 0.01) {                        // Taylor; the next terms are below 1e-17
    c = 1 - x / 2 * (1 - x / 12 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90))));
    s = 0.5 * (1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110)))));
  } else {
    const double half = std::sqrt(x);
    c = fixed::cos(half);
    s = fixed::sin(half) / (2 * half);
  }
  return {c, s * v.x(), s * v.y(), s * v.z()};
}

/// A rotation's vector φ (|φ| ≤ π) and the symmetric part of how it changes: dφ = rate(φ) dθ, dθ a small
/// rotation applied after (from the left), rate = 1 − ½[φ]× + quadratic [φ]×².
struct RotationLog {
  Vec3 vector;
  double quadratic;

  Mat3 rate() const {
    const Mat3 s = skew(vector);
    return Mat3::Identity() - 0.5 * s + quadratic * s * s;
  }
};

inline RotationLog rotation_log(const Quat& q) {
  const double sign = q.w() < 0 ? -1 : 1;  // q and −q are one rotation: take the one of |φ| ≤ π
  const Vec3 v = sign * q.vec();
  const double w = sign * q.w(), s2 = v.squaredNorm();
  if (s2 < 0.0025) {  // φ = 2 asin(s)/s v, and (1 − h cot h)/4h² with h = |φ|/2; the next terms are below
                      // 1e-16, 1e-13
    const double f =
        1 + s2 / 6 * (1 + s2 * 9 / 20 * (1 + s2 * 25 / 42 * (1 + s2 * 49 / 72 * (1 + s2 * 81 / 110))));
    const double h2 = f * f * s2;
    return {2 * f * v, 1.0 / 12 + h2 / 180 + h2 * h2 / 1890 + h2 * h2 * h2 / 18900};
  }
  const double s = std::sqrt(s2), half = fixed::atan2(s, w);
  return {(2 * half / s) * v, (1 - half * w / s) / (4 * half * half)};
}

/// From one rotation (share 0) to another (share 1) the short way, at a steady rate.
inline Quat rotation_between(const Quat& from, const Quat& to, double share) {
  return from * rotation_exp(share * rotation_log(from.conjugate() * to).vector);
}

}  // namespace liana
