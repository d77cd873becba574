// Air and solids that move: they push it, drag it, keep it out and let it through again.
#include <gtest/gtest.h>

#include "mesher/base/hash.h"
#include "mesher/base/random.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/wind/air/sph_wind.h"
#include "runtime/world/world_drawing.h"

namespace liana {
namespace {

constexpr double kSpacing = 0.1;

/// Still air in a cube of 1.5 m about the origin, and a solid that goes through it.
struct Swept {
  Swept(const Mesh& mesh, const ObstaclePose& start, unsigned threads = 1)
      : solid(mesh, {.voxel = 0.03}), solids{&solid} {
    solid.place(start);
    options.low = Vec3::Constant(-6), options.high = Vec3::Constant(6);
    options.spacing = kSpacing;
    options.viscosity = 0.005 * 1.3 * options.sound_speed * 2 * kSpacing;  // as SphWindParameters' ratio
    options.capacity = 5000;
    options.threads = threads;
    walls.emplace(options.low, kSpacing / 2, 4 * kSpacing, solids, 1);
    air.emplace(options, nullptr, &*walls);
    for (int x = 0; x < 15; ++x)
      for (int y = 0; y < 15; ++y)
        for (int z = 0; z < 15; ++z) refused += !air->add(kSpacing * Vec3(x - 7, y - 7, z - 7), Vec3::Zero());
  }
  /// One step in which the solid moves on with these velocities (m/s, rad/s) about its pose's centre.
  void step(const Vec3& velocity, const Vec3& spin, double dt) {
    ObstaclePose pose = solid.pose();
    const Quat turn(Eigen::AngleAxisd(dt * spin.norm(), spin.norm() > 0 ? spin.normalized() : Vec3::UnitX()));
    const Vec3 centre = pose.centre + dt * velocity;
    pose.position = centre + turn * (pose.position - pose.centre);
    pose.rotation = turn * pose.rotation;
    pose.centre = centre, pose.velocity = velocity, pose.angular_velocity = spin;
    solid.place(pose);
    walls->place(dt);
    air->step(dt);
  }
  /// m, of the particle nearest to the solid or deepest in it.
  double nearest() const {
    double least = 1;
    for (size_t i = 0; i < air->size(); ++i) {
      double d = solid.distance(air->position(i));
      if (d <= -solid.band()) d = solid.closest_point(air->position(i)).distance;
      least = std::min(least, d);
    }
    return least;
  }

  SdfObstacle solid;
  const SdfObstacle* solids[1];
  AirOptions options;
  std::optional<MovingWalls> walls;
  std::optional<SphAir> air;
  size_t refused = 0;
};

TEST(AirAtMovingWalls, APlateSweepsTheAirBeforeIt) {
  // 1.2 m wide, 6 cm thick, from one face of the cube of air half of the way to the other.
  Swept run(box_mesh({-0.03, -0.6, -0.6}, {0.03, 0.6, 0.6}),
            {.position = {-0.8, 0, 0}, .centre = {-0.8, 0, 0}});
  EXPECT_EQ(run.refused, 0u);
  const double dt = 0.01, speed = 1;
  for (int i = 0; i < 80; ++i) {
    run.step({speed, 0, 0}, Vec3::Zero(), dt);
    ASSERT_GT(run.nearest(), 0) << "step " << i;
  }
  double before = 0, along = 0, behind = 0;  // particles in the middle of the plate
  for (size_t i = 0; i < run.air->size(); ++i) {
    const Vec3 x = run.air->position(i);
    if (x.tail<2>().cwiseAbs().maxCoeff() > 0.3) continue;
    if (x.x() > 0 && x.x() < 2 * kSpacing) ++before, along += run.air->velocity(i).x();
    behind += x.x() < 0;
  }
  EXPECT_GE(before, 40) << "a layer of 7 x 7, less what the first flow took aside";
  EXPECT_NEAR(along / before, speed, 0.1 * speed);
  EXPECT_LT(behind, 1) << "none came through";
}

// Fast: a point of the box at its corner passes the speed of sound, as nothing in a scene should.
TEST(AirAtMovingWalls, NothingGetsInsideABoxThatFliesAndTumbles) {
  Swept run(box_mesh(Vec3::Constant(-0.25), Vec3::Constant(0.25)),
            {.position = {-1.2, 0.1, 0}, .centre = {-1.2, 0.1, 0}});
  const size_t all = run.air->size();
  double nearest = 1;
  const double dt = 0.002;
  for (int i = 0; i < 200; ++i) {
    run.step({6 * std::cos(0.03 * i), 0.3, 0}, {3, 20, -5}, dt);
    nearest = std::min(nearest, run.nearest());
  }
  // A quarter of a spacing is kept to the wall as it was, whose surface turns by 0.043 rad in a step.
  EXPECT_GT(nearest, 0.15 * kSpacing);
  RecordProperty("nearest_over_spacing", std::to_string(nearest / kSpacing));
  EXPECT_EQ(run.air->size(), all) << "pushed aside, not taken out";
  EXPECT_EQ(run.air->limited(), 0u);
}

TEST(AirAtMovingWalls, ASpinningDrumDragsTheAirRound) {
  Swept run(box_mesh({-0.3, -0.9, -0.3}, {0.3, 0.9, 0.3}), {});
  EXPECT_GT(run.refused, 100u) << "the air that would be in it";
  for (int i = 0; i < 100; ++i) run.step(Vec3::Zero(), {0, 4, 0}, 0.005);
  double round = 0, count = 0;
  for (size_t i = 0; i < run.air->size(); ++i) {
    const Vec3 x = run.air->position(i);
    const double radius = std::hypot(x.x(), x.z());
    if (radius > 0.6 || std::abs(x.y()) > 0.4) continue;
    round += Vec3::UnitY().cross(x).dot(run.air->velocity(i)) / radius, ++count;
  }
  EXPECT_GT(count, 50);
  EXPECT_GT(round / count, 0.5) << "m/s of about 1.6 at the corners";
}

TEST(AirAtMovingWalls, WhatHasNoRoomIsTakenOut) {
  Swept run(box_mesh(Vec3::Constant(-0.25), Vec3::Constant(0.25)),
            {.position = {-5, 0, 0}, .centre = {-5, 0, 0}});
  const size_t all = run.air->size();
  run.solid.place({});  // at once, by no velocity
  run.walls->place(0);
  EXPECT_FALSE(run.air->add({0.2, 0, 0}, Vec3::Zero()));
  for (int i = 0; i < 3; ++i) run.air->step(0.005);
  run.air->sort();
  EXPECT_GT(run.nearest(), 0);
  EXPECT_LT(run.air->size(), all - 50) << "125 were in the box, some so near its faces that they are pushed";
  EXPECT_EQ(run.air->left(), all - run.air->size());
}

TEST(AirAtMovingWalls, OneAndTwoThreadsAgreeToTheBit) {
  uint64_t hash[2];
  for (const unsigned threads : {1u, 2u}) {
    Swept run(box_mesh(Vec3::Constant(-0.25), Vec3::Constant(0.25)),
              {.position = {-0.9, 0, 0}, .centre = {-0.9, 0, 0}}, threads);
    for (int i = 0; i < 60; ++i) run.step({2, 0, 0.3}, {1, 5, 0}, 0.005);
    hash[threads - 1] = hash_bytes(run.air->states(), run.air->size() * sizeof(AirState));
  }
  EXPECT_EQ(hash[0], hash[1]);
}

SphWindParameters jet() {
  SphWindParameters parameters;
  parameters.low = {-0.5, 0, -1.5}, parameters.high = {3, 3, 1.5};
  parameters.spacing = 0.12;
  EmitterParameters emitter;
  emitter.center = {0, 1.5, 0}, emitter.direction = {1, 0, 0};
  emitter.speed = 4, emitter.radius = 0.4;
  parameters.emitters = {emitter};
  return parameters;
}

TEST(SphWind, TakesShorterStepsOnlyWhereSomethingFastIsNear) {
  SdfObstacle box(box_mesh(Vec3::Constant(-0.2), Vec3::Constant(0.2)), {.voxel = 0.05});
  const SdfObstacle* moving[] = {&box};
  const SphWind alone(jet()), wind(jet(), {}, {}, moving);
  const auto at = [&](const Vec3& place, double speed) {
    box.place({.position = place, .centre = place, .velocity = {speed, 0, 0}});
    return wind.substeps(0.025);
  };
  EXPECT_EQ(at({1, 1, 0}, 0), alone.substeps(0.025));
  EXPECT_EQ(at({1, 1, 0}, 1), alone.substeps(0.025));
  EXPECT_EQ(at({1, 1, 0}, 48), 20) << "6 cm a substep, half of a spacing";
  EXPECT_EQ(at({9, 1, 0}, 48), alone.substeps(0.025)) << "far away";
}

// A plate stands before the fan for a second and is drawn up out of the jet.
class PlateInAScene : public ::testing::Test {
 protected:
  PlateInAScene() {
    scene_.wind.air = jet();
    scene_.wind.show_air = true;
    SceneObstacle plate;
    plate.name = "plate";
    plate.mesh = box_mesh({1.2, 0, -1.6}, {1.3, 3.2, 1.6});
    plate.motion.emplace();
    plate.motion->keys = {{1, Vec3::Zero(), Quat::Identity()}, {2, {0, 3.1, 0}, Quat::Identity()}};
    scene_.obstacles = {plate};
  }
  static size_t behind(const World& world) {
    size_t count = 0;
    for (const auto& streak : drawing_of(world).streaks) count += streak.to.x() > 1.35;
    return count;
  }
  static void run(World& world, double seconds) {
    for (int i = 0; i < std::lround(seconds / world.time_step()); ++i) world.step();
  }
  Scene scene_;
};

TEST_F(PlateInAScene, LetsTheWindThroughOnceItIsMovedAway) {
  World world(with_united_solids(scene_), 1);
  run(world, 1);
  EXPECT_GT(world.report().air->emitted, 500u);
  EXPECT_EQ(behind(world), 0u);
  run(world, 2);
  EXPECT_GT(behind(world), 200u);
}

TEST_F(PlateInAScene, ShutsTheWindOffOnceItIsThere) {
  scene_.obstacles[0].motion->keys = {{0, {0, 3.2, 0}, Quat::Identity()},
                                      {1, Vec3::Zero(), Quat::Identity()}};
  World world(with_united_solids(scene_), 1);
  run(world, 0.8);
  const size_t before = behind(world);
  EXPECT_GT(before, 100u);
  run(world, 3);
  EXPECT_LT(behind(world), before / 5) << "of what was there; nothing new came";
}

}  // namespace
}  // namespace liana
