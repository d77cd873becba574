#include "runtime/view/editor_core.h"

#include <gtest/gtest.h>

#include "runtime/view/overlays.h"
#include "tests/support/plants/draw_plants.h"

namespace liana {
namespace {

using support::FakeSimulation;

EditorOptions facing() {
  EditorOptions options;
  options.width = 640;
  options.height = 360;
  options.camera = Camera::parse("pivot 0 0.5 0 distance 3");
  return options;
}

struct Editor : testing::Test {
  FakeSimulation world{support::forked_plant()};
  EditorCore core{world, facing()};

  Vec3 pixel_of(const Vec3& point) const { return core.camera().project(point, core.width(), core.height()); }
  void press(const Vec3& pixel, MouseButton button = MouseButton::Left, bool shift = false,
             bool alt = false) {
    core.handle(ButtonEvent{button, true, pixel.x(), pixel.y(), shift, alt});
  }
  void move(double x, double y) { core.handle(MoveEvent{x, y}); }
  void release(const Vec3& pixel, MouseButton button = MouseButton::Left) {
    core.handle(ButtonEvent{button, false, pixel.x(), pixel.y()});
  }
};

TEST_F(Editor, PicksTheParticleUnderThePixel) {
  for (const size_t i : {0u, 5u, 9u, 13u, 14u}) {
    const Vec3 pixel = pixel_of(world.plant(0).motion[i].position);
    const auto pick = pick_particle(world, {}, core.camera(), pixel.x(), pixel.y(), 640, 360);
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->particle.index(), i);
    EXPECT_LT(pick->on_particle.norm(), 0.01);
  }
  EXPECT_FALSE(pick_particle(world, {}, core.camera(), 60, 60, 640, 360));
}

TEST_F(Editor, DoesNotPickThroughAWall) {
  const Vec3 pixel = pixel_of(world.plant(0).motion[5].position);
  const std::vector<DrawMesh> wall{{support::box_mesh({-1, 0, 0.5}, {1, 2, 0.6}), {1, 1, 1}, false, ""}};
  EXPECT_FALSE(pick_particle(world, wall, core.camera(), pixel.x(), pixel.y(), 640, 360));
  const std::vector<DrawMesh> behind{{support::box_mesh({-1, 0, -0.6}, {1, 2, -0.5}), {1, 1, 1}, false, ""}};
  EXPECT_TRUE(pick_particle(world, behind, core.camera(), pixel.x(), pixel.y(), 640, 360));
}

TEST_F(Editor, DraggingABranchMovesItToTheMouseAndReleases) {
  const Vec3 start = world.plant(0).motion[9].position, pixel = pixel_of(start);
  press(pixel);
  ASSERT_TRUE(core.grab());
  EXPECT_EQ(core.grab()->particle.index(), 9u);
  ASSERT_TRUE(world.grab());
  EXPECT_GT(world.grab()->stiffness(0, 0), 0);
  move(pixel.x() + 50, pixel.y() - 20);
  for (int i = 0; i < 60; ++i) core.advance(0.025);  // the fake world halves the distance each step
  const Vec3 reached = pixel_of(world.plant(0).motion[9].position);
  EXPECT_NEAR(reached.x(), pixel.x() + 50, 1e-6);
  EXPECT_NEAR(reached.y(), pixel.y() - 20, 1e-6);
  EXPECT_NEAR(reached.z(), pixel.z(), 1e-9);  // in the plane parallel to the screen
  release(reached);
  EXPECT_FALSE(world.grab());
  EXPECT_FALSE(core.grab());
}

// Its own weight stretches a grab by 2 cm, whatever the world's gravity; without any it still pulls.
TEST_F(Editor, AGrabIsAsStrongAsTheWorldsGravity) {
  double mass = 0;
  for (const Particle& particle : world.plant(0).particles) mass += particle.mass;
  const Vec3 pixel = pixel_of(world.plant(0).motion[9].position);
  for (const double gravity : {9.81, 1.62, 0.0}) {
    world.world_gravity = {0, -gravity, 0};
    press(pixel);
    ASSERT_TRUE(world.grab());
    const double weight = (gravity > 0 ? gravity : 9.81) * mass;
    EXPECT_NEAR(world.grab()->stiffness(1, 1), weight / 0.02, 1e-9 * weight);
    EXPECT_NEAR(world.grab()->damping(1, 1), 2 * world.time_step() * weight / 0.02, 1e-9 * weight);
    release(pixel);
  }
}

TEST_F(Editor, DraggingEmptySpaceOrbitsAndLeavesTheWorldAlone) {
  const Camera before = core.camera();
  press({60, 60, 0});
  move(90, 70);
  EXPECT_FALSE(world.grab());
  EXPECT_NE(core.camera().azimuth, before.azimuth);
  EXPECT_EQ(core.camera().pivot, before.pivot);
  release({90, 70, 0});
  const double azimuth = core.camera().azimuth;
  move(200, 200);  // no button: nothing moves
  EXPECT_EQ(core.camera().azimuth, azimuth);
}

TEST_F(Editor, MiddleOrbitsShiftPansAltKeepsFromGrabbing) {
  const Vec3 on_stem = pixel_of(world.plant(0).motion[5].position);
  const auto drag = [&](MouseButton button, bool shift, bool alt) {
    press(on_stem, button, shift, alt);
    move(on_stem.x() + 20, on_stem.y());
    release({on_stem.x() + 20, on_stem.y(), 0}, button);
  };
  const Camera start = core.camera();
  drag(MouseButton::Middle, false, false);
  EXPECT_NE(core.camera().azimuth, start.azimuth);
  EXPECT_EQ(core.camera().pivot, start.pivot);
  drag(MouseButton::Left, false, true);
  EXPECT_EQ(core.camera().pivot, start.pivot);
  const Camera turned = core.camera();
  drag(MouseButton::Middle, true, false);
  EXPECT_EQ(core.camera().azimuth, turned.azimuth);
  EXPECT_NE(core.camera().pivot, turned.pivot);
  EXPECT_FALSE(world.grab());
}

TEST_F(Editor, PausedWorldStandsStillUntilStepped) {
  core.handle(KeyEvent{Key::Pause});
  core.advance(1);
  EXPECT_EQ(world.stats().steps, 0u);
  core.handle(KeyEvent{Key::Step});
  EXPECT_EQ(world.stats().steps, 1u);
  EXPECT_TRUE(core.paused());
}

TEST_F(Editor, TimeFollowsTheClockAndDropsWhatASlowMachineCannotDo) {
  for (int i = 0; i < 40; ++i) core.advance(0.0125);  // half a second
  EXPECT_EQ(world.stats().steps, 20u);
  core.advance(10);
  EXPECT_EQ(world.stats().steps, 20u + EditorCore::kMostSteps);
}

TEST_F(Editor, PausedAndUntouchedDrawsOnceCoarselyAndOnceFinely) {
  HeadlessContext context;
  Renderer renderer;
  core.handle(KeyEvent{Key::Pause});
  EXPECT_TRUE(core.draw(renderer, 0));
  EXPECT_FALSE(core.draw(renderer, 0.01));
  EXPECT_TRUE(core.draw(renderer, 1));
  EXPECT_TRUE(core.refined());
  EXPECT_FALSE(core.draw(renderer, 2));
  core.handle(ScrollEvent{1});
  EXPECT_TRUE(core.draw(renderer, 0));
}

TEST_F(Editor, FrameAllShowsThePlant) {
  core.handle(ScrollEvent{-20});
  core.handle(KeyEvent{Key::FrameAll});
  const Vec3 foot = pixel_of({0, 0, 0}), tip = pixel_of({0, 1, 0});
  EXPECT_GT(foot.y() - tip.y(), 180);  // more than half the picture
  EXPECT_GT(tip.y(), 0);
  EXPECT_LT(foot.y(), 360);
}

TEST_F(Editor, OverlayDrawsItsTextIntoThePicture) {
  HeadlessContext context;
  FrameTarget target(640, 360, 1);
  Overlay overlay;
  const auto picture = [&](bool stats_shown) {
    target.bind();
    OverlayText text;
    text.stats = world.stats();
    text.stats_shown = stats_shown;
    overlay.draw(text, 640, 360);
    overlay.draw(text, 640, 360);  // ImGui sizes a window in its first frame
    return target.read();
  };
  const Image with = picture(true);
  size_t bright = 0;
  for (int y = 10; y < 120; ++y)
    for (int x = 10; x < 160; ++x) bright += with.at(x, y)[0] > 200;
  EXPECT_GT(bright, 200u);  // letters in the corner
}

}  // namespace
}  // namespace liana
