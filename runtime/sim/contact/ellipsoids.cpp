#include "runtime/sim/contact/ellipsoids.h"

#include <cmath>

namespace liana {
namespace {

/// S⁻¹ r of a symmetric matrix.
Vec3 solve(const Mat3& s, const Vec3& r) {
  const Vec3 x = s.col(1).cross(s.col(2)), y = s.col(2).cross(s.col(0)), z = s.col(0).cross(s.col(1));
  return Vec3(x.dot(r), y.dot(r), z.dot(r)) / s.col(0).dot(x);
}

}  // namespace

// f(λ) = λ(1-λ) rᵀ((1-λ)A + λB)⁻¹r is concave; with y = ((1-λ)A + λB)⁻¹r its slope is (1-λ)² yᵀAy - λ² yᵀBy,
// which vanishes where (1-λ) a = λ b for the reaches a and b along y. Its root by the Illinois method.
EllipsoidTouch touch(const Ellipsoid& a, const Ellipsoid& b, double far) {
  constexpr int kMost = 40;
  constexpr double kExact = 1e-6;
  constexpr double kCoincide = 1e-9;  // m
  const Mat3 of_a = a.axes * a.axes.transpose(), of_b = b.axes * b.axes.transpose();
  Vec3 r = a.centre - b.centre;
  if (r.squaredNorm() < kCoincide * kCoincide) r = kCoincide * a.axes.col(2).stableNormalized();
  // The share by which a's reach is too large for λ, at both ends of where λ is: guesses at first.
  double low = 0, high = 1, at_low = 0.5, at_high = -0.5, before = 0;
  for (int i = 1;; ++i) {
    const double lambda = low + (high - low) * at_low / (at_low - at_high);
    const Vec3 n = solve((1 - lambda) * of_a + lambda * of_b, r).normalized();
    const double reach_a = a.reach(n), reach_b = b.reach(n), reach = reach_a + reach_b, way = n.dot(r);
    const double value = reach_a / reach - lambda;
    if (way - reach > far || std::abs(value) < kExact || i == kMost)
      return {n, way - reach, b.centre + way / reach / reach_b * (of_b * n)};
    (value > 0 ? low : high) = lambda;
    (value > 0 ? at_low : at_high) = value;
    if (value * before > 0) (value > 0 ? at_high : at_low) /= 2;
    before = value;
  }
}

}  // namespace liana
