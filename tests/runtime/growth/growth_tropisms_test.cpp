#include <gtest/gtest.h>

#include "runtime/growth/shoot_growth.h"
#include "runtime/growth/tropisms.h"

namespace liana {
namespace {

const Vec3 kToWall(0, 0, -1);  // v̂_s: the wall is behind, in -Z

Vec3 tilted(double into_wall) {
  return Vec3(0, std::cos(into_wall), -std::sin(into_wall));
}

TEST(SurfaceAdaption, AFacingTipTurnsAwayUntilItLiesAlong) {
  Vec3 forward = tilted(0.8);
  double before = forward.dot(kToWall);
  for (int i = 0; i < 400; ++i) {
    forward = surface_adaption(forward, kToWall, 0, 0.05, Vec3::UnitX()) * forward;
    EXPECT_LE(forward.dot(kToWall), before + 1e-12);
    before = forward.dot(kToWall);
  }
  EXPECT_NEAR(before, 0, 1e-3);
  EXPECT_GT(forward.y(), 0.999) << "the shorter way round";
}

TEST(SurfaceAdaption, ALeavingTipTurnsBackUntilItLiesAlong) {
  Vec3 forward = tilted(-0.8);
  for (int i = 0; i < 400; ++i)
    forward = surface_adaption(forward, kToWall, 0, 0.05, Vec3::UnitX()) * forward;
  EXPECT_NEAR(forward.dot(kToWall), 0, 1e-3);
  EXPECT_GT(forward.y(), 0.999);
}

TEST(SurfaceAdaption, AParallelTipGoesOn) {
  const Quat turn = surface_adaption(Vec3::UnitY(), kToWall, 0, 0.5, Vec3::UnitX());
  EXPECT_NEAR(turn.angularDistance(Quat::Identity()), 0, 1e-12);
}

TEST(SurfaceAdaption, TurnsByTheDotProductOfEq6) {
  const double tau_dt = 0.01;
  const Quat turn = surface_adaption(tilted(0.5), kToWall, 0, tau_dt, Vec3::UnitX());
  EXPECT_NEAR(turn.angularDistance(Quat::Identity()), std::sin(0.5) * tau_dt, 1e-12);
}

TEST(SurfaceAdaption, ASquareTipTurnsAboutTheGivenAxis) {
  // About +X, from -Z towards +Y.
  const Vec3 turned = surface_adaption(kToWall, kToWall, 0, 0.1, Vec3::UnitX()) * kToWall;
  EXPECT_NEAR(turned.y(), std::sin(0.1), 1e-12);
}

TEST(SurfaceAdaption, NeverTurnsPastItsRest) {
  for (const double lean : {-0.4, 0.0, 0.5}) {
    const Vec3 turned = surface_adaption(tilted(0.9), kToWall, lean, 100, Vec3::UnitX()) * tilted(0.9);
    EXPECT_NEAR(turned.dot(kToWall), lean, 1e-9);
  }
}

TEST(Phototropism, TurnsTowardsTheLightByEq7AndNotPastIt) {
  const Vec3 light = Vec3(1, 1, 0).normalized();
  const Vec3 turned = phototropism(Vec3::UnitY(), light, 0.25, 0.1) * Vec3::UnitY();
  EXPECT_NEAR(std::acos(turned.dot(light)), kPi / 4 - 0.75 * 0.1, 1e-9);
  EXPECT_NEAR((phototropism(Vec3::UnitY(), light, 0, 10) * Vec3::UnitY()).dot(light), 1, 1e-12);
  EXPECT_NEAR(phototropism(Vec3::UnitY(), light, 1, 0.1).angularDistance(Quat::Identity()), 0, 1e-12)
      << "in the dark";
}

TEST(Course, RunsUpAWallTurnedByItsAngleAndVanishesOnLevelGround) {
  EXPECT_LT((course_on_surface(Vec3::UnitZ(), 0) - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((course_on_surface(Vec3::UnitZ(), kPi / 2) + Vec3::UnitX()).norm(), 1e-12);
  EXPECT_TRUE(course_on_surface(Vec3::UnitY(), 0.3).isZero(0));
}

}  // namespace
}  // namespace liana
