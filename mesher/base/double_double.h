// Exact sums and products of two doubles as a double and its rounding error, without fused operations
// [Dekker 1971; Knuth, The Art of Computer Programming 2, 4.2.2].
#pragma once

#include <limits>

namespace liana::fixed {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kToWhole = 0x1.8p52;  // added and taken away: rounds to the nearest whole number

/// high + low, |low| at most half a unit in the last place of high.
struct Pair {
  double high, low;
};

inline Pair two_sum(double a, double b) {
  const double s = a + b, from_b = s - a;
  return {s, (a - (s - from_b)) + (b - from_b)};
}

/// |a| >= |b|, or a is zero.
inline Pair fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// |a|, |b| below 1e150, and the product above 1e-290 or zero.
inline Pair two_product(double a, double b) {
  constexpr double kSplit = 134217729;  // 2²⁷ + 1: halves of 26 bits
  const double p = a * b, ca = kSplit * a, cb = kSplit * b;
  const double ah = ca - (ca - a), al = a - ah, bh = cb - (cb - b), bl = b - bh;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

inline Pair operator+(const Pair& a, const Pair& b) {
  const Pair s = two_sum(a.high, b.high);
  return fast_two_sum(s.high, s.low + (a.low + b.low));
}

inline Pair operator*(const Pair& a, const Pair& b) {
  const Pair p = two_product(a.high, b.high);
  return fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

}  // namespace liana::fixed
