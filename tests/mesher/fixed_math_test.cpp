// Our elementary functions against the C library's in long double, and their edges.
#include "mesher/base/fixed_math.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "mesher/base/random.h"

namespace liana {
namespace {

constexpr int kPoints = 300'000;  // a range; a million and more for each function
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Units in the last place (of doubles near the true value) between the two.
double ulps(double found, long double truth) {
  if (std::isinf(found) || std::fabs(truth) > DBL_MAX)
    return std::isinf(found) && std::fabs(truth) > DBL_MAX ? 0 : 1e9;
  const auto near = static_cast<double>(std::fabs(truth));
  const int exponent = std::max(near > 0 ? std::ilogb(near) : -1022, -1022);
  return static_cast<double>(std::fabs(found - truth) / std::scalbn(1.0L, exponent - 52));
}

struct Range {
  double low, high;
  bool log_scale = false;  // both positive: evenly spread by order of magnitude
};

double draw(Random& random, const Range& range) {
  const double t = random.uniform() + random.uniform() * 0x1p-32;
  return range.log_scale ? range.low * std::pow(range.high / range.low, t)
                         : range.low + (range.high - range.low) * t;
}

template <class Ours, class Theirs>
double worst(const Range& range, Ours ours, Theirs theirs) {
  Random random(7, "tests/fixed_math");
  double most = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = draw(random, range);
    most = std::max(most, ulps(ours(x), theirs(static_cast<long double>(x))));
  }
  return most;
}

using L = long double;

TEST(FixedMath, SineAndCosineAreWithinOneUlp) {
  for (const Range& range : {Range{-1, 1}, {-10, 10}, {-1e5, 1e5}, {1e5, 1e15}, {1e-12, 1, true}}) {
    EXPECT_LE(worst(range, fixed::sin, [](L x) { return std::sin(x); }), 1) << range.high;
    EXPECT_LE(worst(range, fixed::cos, [](L x) { return std::cos(x); }), 1) << range.high;
  }
}

TEST(FixedMath, ExponentialAndLogarithmsAreWithinOneUlp) {
  for (const Range& range : {Range{-1, 1}, {-700, 709}, {-745, -708}, {1e-15, 1, true}})
    EXPECT_LE(worst(range, fixed::exp, [](L x) { return std::exp(x); }), 1) << range.low;
  for (const Range& range : {Range{0.5, 2}, {0.999, 1.001}, {1e-320, 1e300, true}})
    EXPECT_LE(worst(range, fixed::log, [](L x) { return std::log(x); }), 1) << range.low;
  for (const Range& range : {Range{-0.9, 2}, {-1e-3, 1e-3}, {1e-18, 1e300, true}})
    EXPECT_LE(worst(range, fixed::log1p, [](L x) { return std::log1p(x); }), 1) << range.low;
}

TEST(FixedMath, PowersAndRootsAreWithinOneUlp) {
  for (const double y : {-3.7, -1.0, -0.5, 1.0 / 3, 5.0 / 6, 1.7, 3.0, 17.25}) {
    const auto ours = [&](double x) { return fixed::pow(x, y); };
    const auto theirs = [&](L x) { return std::pow(x, static_cast<L>(y)); };
    EXPECT_LE(worst({0.5, 2}, ours, theirs), 1) << y;
    EXPECT_LE(worst({1e-15, 1e15, true}, ours, theirs), 1) << y;
  }
  EXPECT_LE(
      worst(
          {0.5, 2}, [](double x) { return fixed::pow(x, 900); }, [](L x) { return std::pow(x, 900.0L); }),
      1);
  EXPECT_LE(worst({1e-300, 1e300, true}, fixed::cbrt, [](L x) { return std::cbrt(x); }), 1);
  for (const double y : {1e-9, 0.3, 7.0, 1e9}) {
    const auto theirs = [&](L x) { return std::hypot(x, static_cast<L>(y)); };
    const auto ours = [&](double x) { return fixed::hypot(x, y); };
    // Three roundings before the root, which halves what they add up to (1 ulp at most), and its own.
    EXPECT_LE(worst({1e-12, 1e12, true}, ours, theirs), 1.5) << y;
  }
}

TEST(FixedMath, InverseFunctionsAreWithinOneUlp) {
  for (const double x : {-3.0, -1e-7, 0.3, 1.0, 1e9}) {
    const auto ours = [&](double y) { return fixed::atan2(y, x); };
    const auto theirs = [&](L y) { return std::atan2(y, static_cast<L>(x)); };
    EXPECT_LE(worst({-4, 4}, ours, theirs), 1) << x;
    EXPECT_LE(worst({1e-290, 1e300, true}, ours, theirs), 1) << x;
  }
  for (const Range& range : {Range{-1, 1}, {0.999999, 1}, {1e-20, 1, true}}) {
    EXPECT_LE(worst(range, fixed::acos, [](L x) { return std::acos(x); }), 1) << range.low;
    EXPECT_LE(worst(range, fixed::asin, [](L x) { return std::asin(x); }), 1) << range.low;
  }
}

TEST(FixedMath, EdgesAreThoseOfC) {
  const double edges[] = {0.0,  -0.0,  1.0,    -1.0,      2.0,        -2.0, 0.5,    -0.5, 3.0,
                          -3.0, 1e300, 5e-324, kInfinity, -kInfinity, NAN,  1e-300, 1e20, -1e20};
  const auto same = [](double ours, double libm) {
    return (std::isnan(ours) && std::isnan(libm)) ||
           (ulps(ours, libm) <= 1 && std::signbit(ours) == std::signbit(libm));
  };
  for (const double x : edges) {
    EXPECT_TRUE(same(fixed::exp(x), std::exp(x))) << x;
    EXPECT_TRUE(same(fixed::log(x), std::log(x))) << x;
    EXPECT_TRUE(same(fixed::log1p(x), std::log1p(x))) << x;
    EXPECT_TRUE(same(fixed::cbrt(x), std::cbrt(x))) << x;
    EXPECT_TRUE(same(fixed::acos(x), std::acos(x))) << x;
    EXPECT_TRUE(same(fixed::asin(x), std::asin(x))) << x;
    if (std::abs(x) < 1e15 || !std::isfinite(x)) {
      EXPECT_TRUE(same(fixed::sin(x), std::sin(x))) << x;
      EXPECT_TRUE(same(fixed::cos(x), std::cos(x))) << x;
    }
    for (const double y : edges) {
      EXPECT_TRUE(same(fixed::atan2(y, x), std::atan2(y, x))) << y << ", " << x;
      EXPECT_TRUE(same(fixed::pow(x, y), std::pow(x, y)))
          << x << " to the " << y << ": " << fixed::pow(x, y) << ", C: " << std::pow(x, y);
    }
  }
}

}  // namespace
}  // namespace liana
