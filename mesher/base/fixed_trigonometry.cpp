#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesher/base/double_double.h"
#include "mesher/base/fixed_math.h"

namespace liana::fixed {
namespace {

constexpr double kQuarterTurn = 0x1.921fb54442d18p+0, kQuarterRest = 0x1.1a62633145c07p-54;

/// x less a whole number of quarter turns; |x.high| at most a little above π/4.
struct Reduced {
  Pair x;
  int quarter;  // modulo 4
};

int modulo_4(double n) {
  return static_cast<int>(n - 4 * std::floor(n / 4));
}

Reduced reduced(double x) {
  constexpr double kPerQuarter = 0x1.45f306dc9c883p-1;
  if (std::abs(x) < 0x1p-1 * kQuarterTurn) return {{x, 0}, 0};
  const double n = (x * kPerQuarter + kToWhole) - kToWhole;
  if (std::abs(n) < 0x1p19) {  // π/2 in parts of 33 bits, of which n times is exact
    const Pair r = two_sum(x - n * 0x1.921fb54400000p+0, -n * 0x1.0b4611a600000p-34);
    return {fast_two_sum(r.high, r.low - n * 0x1.3198a2e037073p-69), modulo_4(n)};
  }
  if (!(std::abs(x) < 0x1p51)) x = std::fmod(x, 4 * kQuarterTurn);
  Pair r = {x, 0};
  double quarters = 0;
  for (int i = 0; i < 2; ++i) {  // the first time n may be one off
    const double m = (r.high * kPerQuarter + kToWhole) - kToWhole;
    for (const double part : {kQuarterTurn, kQuarterRest, -0x1.f1976b7ed8fbcp-110})
      r = r + two_product(-m, part);
    quarters += modulo_4(m);
  }
  return {r, modulo_4(quarters)};
}

constexpr std::array<double, 8> kOfSine = {
    1.0 / 121645100408832000, 1.0 / 355687428096000, 1.0 / 1307674368000, 1.0 / 6227020800,
    1.0 / 39916800,           1.0 / 362880,          1.0 / 5040,          1.0 / 120};  // 19! … 5!
constexpr std::array<double, 8> kOfCosine = {
    1.0 / 6402373705728000, 1.0 / 20922789888000, 1.0 / 87178291200, 1.0 / 479001600,
    1.0 / 3628800,          1.0 / 40320,          1.0 / 720,         1.0 / 24};  // 18! … 4!

/// x − x³/3! + …, as x − ((z (low/2 − z x p) − low) + x³/6).
double sine(const Pair& x) {
  const double z = x.high * x.high, cube = z * x.high;
  double p = 0;  // 1/5! − z/7! + …
  for (const double c : kOfSine) p = c - z * p;
  return x.high - ((z * (x.low / 2 - cube * p) - x.low) + cube * (1.0 / 6));
}

double cosine(const Pair& x) {
  const double z = x.high * x.high, half = z / 2, w = 1 - half;
  double p = 0;  // 1/4! − z/6! + …
  for (const double c : kOfCosine) p = c - z * p;
  return w + (((1 - w) - half) + (z * z * p - x.high * x.low));
}

/// atan(k/8), k = 2 … 8: as a double and the rest.
constexpr std::array<Pair, 9> kArcTangents = {{{0, 0},
                                               {0, 0},
                                               {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                               {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                               {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                               {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                               {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                               {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                               {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};

constexpr std::array<double, 13> kOneOverOdd = {1.0 / 27, 1.0 / 25, 1.0 / 23, 1.0 / 21, 1.0 / 19,
                                                1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9,
                                                1.0 / 7,  1.0 / 5,  1.0 / 3};

/// The angle of a point of the first quadrant with its mirror images: sign · atan(small/large) + base.
double angle_from(const Pair& small, const Pair& large, double sign, const Pair& base) {
  double q = small.high / large.high, q_low = 0;
  if (q > 0x1p-200) {
    const Pair p = two_product(q, large.high);
    q_low = (((small.high - p.high) - p.low) + small.low - q * large.low) / large.high;
  }
  const auto k = q < 0.25 ? 0u : static_cast<unsigned>(8 * q + 0.5);
  double t = q, t_low = q_low;
  if (k > 0) {
    const double place = k / 8.0;
    t = ((q - place) + q_low) / (1 + q * place);
    t_low = 0;
  }
  const double z = t * t;  // t − t³/3 + t⁵/5 …; |t| <= 1/4, and 1/16 beyond the first
  double p = 0;
  for (size_t i = k > 0 ? 6 : 0; i < kOneOverOdd.size(); ++i) p = z * (kOneOverOdd[i] - p);
  const double curve = t_low - t * p;
  const Pair at = kArcTangents[k];
  if (sign > 0 && base.high == 0 && k == 0) return t + curve;
  const Pair s = two_sum(base.high, sign * at.high);
  const Pair with_t = two_sum(s.high, sign * t);
  return with_t.high + (with_t.low + (s.low + (base.low + sign * (at.low + curve))));
}

/// Of the point (x, y), each a double and its rest, neither too large nor too small for products.
double angle_of(const Pair& y, const Pair& x) {
  const Pair up = y.high < 0 ? Pair{-y.high, -y.low} : y, out = x.high < 0 ? Pair{-x.high, -x.low} : x;
  const bool behind = std::signbit(x.high), steep = up.high > out.high;
  const Pair quarter = {kQuarterTurn, kQuarterRest}, half = {2 * kQuarterTurn, 2 * kQuarterRest};
  double angle = 0;
  if (steep)
    angle = angle_from(out, up, behind ? 1 : -1, quarter);
  else if (out.high == 0)
    angle = behind ? half.high : 0;
  else
    angle = angle_from(up, out, behind ? -1 : 1, behind ? half : Pair{0, 0});
  return std::copysign(angle, y.high);
}

/// √(1 − x²).
Pair other_leg(double x) {
  const Pair square = two_product(x, x);
  const Pair w = two_sum(1, -square.high);
  if (!(w.high > 0)) return {0, 0};
  const double root = std::sqrt(w.high);
  const Pair again = two_product(root, root);
  return {root, (((w.high - again.high) - again.low) + (w.low - square.low)) / (2 * root)};
}

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return kNone;
  if (std::abs(x) < 0x1p-27) return x;
  const Reduced r = reduced(x);
  const double size = r.quarter % 2 == 0 ? sine(r.x) : cosine(r.x);
  return r.quarter < 2 ? size : -size;
}

double cos(double x) {
  if (!std::isfinite(x)) return kNone;
  const Reduced r = reduced(x);
  const double size = r.quarter % 2 == 0 ? cosine(r.x) : sine(r.x);
  return r.quarter == 0 || r.quarter == 3 ? size : -size;
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNone;
  if (std::isinf(x) || std::isinf(y)) {
    x = std::copysign(std::isinf(x) ? 1 : 0, x);
    y = std::copysign(std::isinf(y) ? 1 : 0, y);
  }
  const double most = std::max(std::abs(x), std::abs(y));
  const double scale = most > 0x1p400 ? 0x1p-600 : most < 0x1p-400 ? 0x1p600 : 1;
  return angle_of({y * scale, 0}, {x * scale, 0});
}

double acos(double x) {
  return std::abs(x) <= 1 ? angle_of(other_leg(x), {x, 0}) : kNone;
}

double asin(double x) {
  if (!(std::abs(x) <= 1)) return kNone;
  return std::abs(x) < 0x1p-27 ? x : angle_of({x, 0}, other_leg(x));
}

}  // namespace liana::fixed
