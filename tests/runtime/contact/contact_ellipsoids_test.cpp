// Touching ellipsoids: closed forms, and directions tried one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/sim/contact/ellipsoids.h"

namespace liana {
namespace {

constexpr double kNever = 1e9;

struct Shapes {
  std::mt19937 random{7};
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 direction() { return Vec3(number(-1, 1), number(-1, 1), number(-1, 1)).normalized(); }
  /// Stems, blades, pebbles: semi-axes of 1 to 40 mm.
  Ellipsoid ellipsoid() {
    const Mat3 turn = Eigen::AngleAxisd(number(0, kPi), direction()).toRotationMatrix();
    const Vec3 halves(std::pow(10, number(-3, -1.4)), std::pow(10, number(-3, -1.4)),
                      std::pow(10, number(-3, -1.4)));
    return {Vec3::Zero(), turn * halves.asDiagonal()};
  }
};

/// The point of its surface that is furthest along n.
Vec3 furthest(const Ellipsoid& e, const Vec3& n) {
  return e.centre + e.axes * (e.axes.transpose() * n) / e.reach(n);
}

TEST(Ellipsoids, SpheresAreAsFarApartAsTheirCentresLessTheirRadii) {
  const Ellipsoid a{{0.3, 0.1, -0.2}, 0.02 * Mat3::Identity()},
      b{{0.25, 0.12, -0.1}, 0.05 * Mat3::Identity()};
  const Vec3 r = a.centre - b.centre;
  const EllipsoidTouch found = touch(a, b, kNever);
  EXPECT_NEAR(found.gap, r.norm() - 0.07, 1e-12);
  EXPECT_LT((found.normal - r.normalized()).norm(), 1e-12);
}

TEST(Ellipsoids, WhatIsMadeToTouchTouchesThere) {
  Shapes shapes;
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid b = shapes.ellipsoid();
    Ellipsoid a = shapes.ellipsoid();
    const Vec3 n = shapes.direction();
    const Vec3 place = furthest(b, n);
    a.centre = place - furthest(a, -n);
    const EllipsoidTouch found = touch(a, b, kNever);
    EXPECT_NEAR(found.gap, 0, 1e-7) << i;
    EXPECT_LT((found.at - place).norm(), 1e-4) << i;
    // Nothing else of n is certain where one is flat.
    EXPECT_NEAR(a.reach(found.normal) + b.reach(found.normal), found.normal.dot(a.centre - b.centre), 1e-7);
  }
}

TEST(Ellipsoids, TheGapIsNegativeExactlyIfNoPlaneParts) {
  Shapes shapes;
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    Ellipsoid a = shapes.ellipsoid();
    const Ellipsoid b = shapes.ellipsoid();
    a.centre = shapes.number(0, 0.05) * shapes.direction();
    const EllipsoidTouch found = touch(a, b, kNever);
    // The widest of many gaps between parallel planes: the distance, from below.
    double widest = -kNever;
    for (int k = 0; k < 20000; ++k) {
      const Vec3 n = k < 10000 ? shapes.direction() : (found.normal + 0.05 * shapes.direction()).normalized();
      widest = std::max(widest, n.dot(a.centre) - a.reach(n) - b.reach(n));
    }
    if (widest > 0) EXPECT_GT(found.gap, 0) << i;
    apart += found.gap > 0;
    if (std::abs(widest) > 2e-4) EXPECT_EQ(found.gap > 0, widest > 0) << i << " " << widest;
    // Either both or neither hold the point where they would touch.
    const auto inside = [&](const Ellipsoid& e) { return (e.axes.inverse() * (found.at - e.centre)).norm(); };
    EXPECT_NEAR(inside(a), inside(b), 1e-4 * inside(a)) << i;
  }
  EXPECT_GT(apart, 50);
  EXPECT_LT(apart, 250);
}

TEST(Ellipsoids, StopsAtAnyPlaneThatPartsThemWidely) {
  Shapes shapes;
  for (int i = 0; i < 200; ++i) {
    Ellipsoid a = shapes.ellipsoid();
    const Ellipsoid b = shapes.ellipsoid();
    a.centre = shapes.number(0.05, 0.2) * shapes.direction();
    const EllipsoidTouch found = touch(a, b, 0.01), all = touch(a, b, kNever);
    EXPECT_EQ(found.gap > 0.01, all.gap > 0.01) << i << " " << found.gap << " " << all.gap;
    EXPECT_NEAR(found.gap, found.normal.dot(a.centre) - a.reach(found.normal) - b.reach(found.normal), 1e-12);
  }
}

TEST(Ellipsoids, CentresMayCoincide) {
  Shapes shapes;
  const Ellipsoid a = shapes.ellipsoid(), b = shapes.ellipsoid();
  const EllipsoidTouch found = touch(a, b, kNever);
  EXPECT_TRUE(found.normal.allFinite() && found.at.allFinite());
  EXPECT_LT(found.gap, 0);
}

}  // namespace
}  // namespace liana
