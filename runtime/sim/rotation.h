// Rotation vectors: the few formulas that joints and the time step share.
#pragma once

#include <cmath>

#include "mesher/base/types.h"

namespace liana {

/// [v]×: skew(v) w = v × w.
inline Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The rotation by |v| radians about v. Unit to rounding.
inline Quat rotation_exp(const Vec3& v) {
  const double angle2 = v.squaredNorm();
  if (angle2 < 1e-6) {  // series; the next term is below 1e-21
    const double s = 0.5 - angle2 / 48 + angle2 * angle2 / 3840;
    return {1 - angle2 / 8 + angle2 * angle2 / 384, s * v.x(), s * v.y(), s * v.z()};
  }
  const double angle = std::sqrt(angle2), s = std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * v.x(), s * v.y(), s * v.z()};
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
  if (s2 < 1e-8) {  // φ = 2 asin(s)/s v with w = √(1−s²); the next terms are below 1e-16
    return {(2 + s2 / 3) * v, 1.0 / 12 + s2 / 180};
  }
  const double s = std::sqrt(s2), half = std::atan2(s, w);
  return {(2 * half / s) * v, (1 - half * w / s) / (4 * half * half)};
}

}  // namespace liana
