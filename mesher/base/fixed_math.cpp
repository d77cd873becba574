#include "mesher/base/fixed_math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mesher/base/double_double.h"

namespace liana::fixed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// ln 2: its first 32 bits, so that whole multiples are exact, and the rest
constexpr double kLn2 = 0x1.62e42fee00000p-1, kLn2Rest = 0x1.a39ef35793c76p-33;
constexpr double kPerLn2 = 0x1.71547652b82fep+0;

constexpr std::array<double, 12> kReciprocalFactorials = {
    1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320,
    1.0 / 5040,       1.0 / 720,       1.0 / 120,      1.0 / 24,      1.0 / 6,      1.0 / 2};  // 13! … 2!

constexpr std::array<double, 12> kTwoOverOdd = {2.0 / 25, 2.0 / 23, 2.0 / 21, 2.0 / 19, 2.0 / 17, 2.0 / 15,
                                                2.0 / 13, 2.0 / 11, 2.0 / 9,  2.0 / 7,  2.0 / 5,  2.0 / 3};

double power_of_two(int k) {  // of a normal number
  return std::bit_cast<double>(static_cast<uint64_t>(k + 1023) << 52);
}

/// exp(x + low), low a rounding error of x.
double exp_of(double x, double low) {
  if (x > 710) return kInfinity;
  if (x < -746) return 0;
  const double k = (x * kPerLn2 + kToWhole) - kToWhole;
  const double high = x - k * kLn2, rest = k * kLn2Rest - low;
  const double r = high - rest, r_low = (high - r) - rest;  // |r| <= ln 2 / 2
  double p = 0;                                             // 1/2 + r/3! + …
  for (const double c : kReciprocalFactorials) p = c + r * p;
  const double e = 1 + (r + (r * r * p + r_low));
  const int whole = static_cast<int>(k), half = whole / 2;
  return e * power_of_two(half) * power_of_two(whole - half);
}

/// x = 2^exponent (1 + f), 1 + f in [√½, √2); x positive and finite.
struct Scaled {
  double f;
  int exponent;
};
Scaled scaled(double x) {
  int extra = 0;
  if (x < 0x1p-1022) x *= 0x1p54, extra = -54;
  const auto bits = std::bit_cast<uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023 + extra;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffull) | 0x3ff0000000000000ull);
  if (m >= 0x1.6a09e667f3bcdp+0) m /= 2, ++exponent;
  return {m - 1, exponent};
}

/// log(x) + low, x positive and finite: with s = f/(2+f), log(1+f) = f − f²/2 + s (f²/2 + 2/3 s² + 2/5 s⁴ +
/// …).
double log_of(double x, double low) {
  const auto [f, exponent] = scaled(x);
  const double s = f / (2 + f), z = s * s, half_square = f * f / 2;
  double series = 0;
  for (const double c : kTwoOverOdd) series = z * (c + series);
  const double k = exponent;
  return k * kLn2 - ((half_square - (s * (half_square + series) + (k * kLn2Rest + low))) - f);
}

/// log(x) to some 65 bits, x positive and finite: 2 artanh s = 2s + 2/3 s³ + 2/5 s⁵ + …
Pair exact_log(double x) {
  const auto [f, exponent] = scaled(x);
  const Pair d = two_sum(2, f);
  const double s = f / d.high;
  const Pair product = two_product(s, d.high);
  const Pair root = fast_two_sum(s, ((f - product.high) - product.low - s * d.low) / d.high);
  const Pair z = root * root;
  double series = 0;
  for (size_t i = 0; i + 1 < kTwoOverOdd.size(); ++i) series = z.high * (kTwoOverOdd[i] + series);
  const Pair two_thirds = fast_two_sum(kTwoOverOdd.back(), series + 0x1.5555555555555p-55);
  const Pair third = root * (z * two_thirds);
  const double k = exponent;
  return Pair{k * kLn2, 0} + (two_product(k, kLn2Rest) + (Pair{2 * root.high, 2 * root.low} + third));
}

double pow_of_positive(double x, double y) {
  const Pair l = exact_log(x);
  const double about = y * l.high;
  if (about > 710) return kInfinity;
  if (about < -746) return 0;
  if (std::abs(about) < 0x1p-60) return 1;
  const Pair power = two_product(y, l.high);
  return exp_of(power.high, power.low + y * l.low);
}

}  // namespace

double exp(double x) {
  return std::isnan(x) ? x : exp_of(x, 0);
}

double log(double x) {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNone;
  return x == kInfinity ? x : log_of(x, 0);
}

double log1p(double x) {
  if (!(x > -1)) return x == -1 ? -kInfinity : kNone;
  if (std::abs(x) < 0x1p-53 || x == kInfinity) return x;
  const Pair u = two_sum(1, x);
  return log_of(u.high, u.low / u.high);
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return kNone;
  if (y == 1) return x;
  if (y == 2) return x * x;
  if (y == 0.5 && x > 0) return std::sqrt(x);
  const double size = std::abs(x);
  const bool whole = std::trunc(y) == y, odd = whole && std::abs(y) < 0x1p53 && std::fmod(y, 2) != 0;
  const double sign = std::signbit(x) && odd ? -1 : 1;
  if (std::isinf(y)) return size == 1 ? 1 : (size > 1) == (y > 0) ? kInfinity : 0;
  if (size == 0 || size == kInfinity) return (size == 0) == (y > 0) ? sign * 0.0 : sign * kInfinity;
  if (x < 0 && !whole) return kNone;
  if (std::abs(y) > 0x1p100 && size != 1) return (size > 1) == (y > 0) ? sign * kInfinity : sign * 0.0;
  return sign * pow_of_positive(size, y);
}

double cbrt(double x) {
  const double size = std::abs(x);
  if (!(size > 0) || size == kInfinity) return x;
  const auto [f, exponent] = scaled(size);
  const int third = (exponent + 3 * 1024) / 3 - 1024;  // rounded down
  const double m = (1 + f) * power_of_two(exponent - 3 * third);
  double y = 0.6 + 0.35 * m;  // m in [0.7, 5.7): within a half; Newton's steps square that
  for (int i = 0; i < 6; ++i) y = (2 * y + m / (y * y)) / 3;
  const Pair square = two_product(y, y), cube = two_product(square.high, y);
  y += (((m - cube.high) - cube.low) - square.low * y) / (3 * square.high);
  return std::copysign(y * power_of_two(third), x);
}

double hypot(double x, double y) {
  return std::sqrt(x * x + y * y);
}

}  // namespace liana::fixed
