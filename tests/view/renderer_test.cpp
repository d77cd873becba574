#include "runtime/view/renderer.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "mesher/base/error.h"
#include "tests/support/scenes/draw_scenes.h"

namespace liana {
namespace {

FrameOptions small() {
  return {.width = 320, .height = 180, .shadow_size = 512};
}
Camera in_front() {
  return Camera::parse("pivot 0.6 1.45 0 distance 6.2 azimuth -24 elevation 8");
}

/// Mean of the channels over part of the picture's rows.
Vec3 mean(const Image& image, int first_row, int last_row) {
  Vec3 sum = Vec3::Zero();
  for (int y = first_row; y < last_row; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += image.at(x, y)[c];
  return sum / ((last_row - first_row) * image.width);
}

Vec3 pixel(const Image& image, double x, double y) {
  const uint8_t* p = image.at(int(x), int(y));
  return {double(p[0]), double(p[1]), double(p[2])};
}

TEST(HeadlessContext, NeedsNoDisplay) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  HeadlessContext context;
  EXPECT_FALSE(context.description().empty());
}

TEST(HeadlessContext, WithoutADriverNamesWhatToInstall) {
  testing::FLAGS_gtest_death_test_style =
      "threadsafe";  // a new process, in which no driver was loaded before
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json", 1);
        try {
          HeadlessContext context;
        } catch (const Error& error) {
          std::exit(error.hint.find("libgl1-mesa-dri") != std::string::npos ? 3 : 4);
        }
        std::exit(5);
      },
      testing::ExitedWithCode(3), "");
}

TEST(Renderer, EmptySceneHasBlueSkyAboveAndGroundBelow) {
  HeadlessRenderer renderer;
  const Image image = renderer.render({}, Camera::parse("pivot 0 1 0 distance 5 elevation 5"), small());
  const Vec3 sky = mean(image, 0, 60), ground = mean(image, 120, 180);
  EXPECT_GT(sky.z(), sky.x() + 10);        // blue
  EXPECT_GT(ground.y(), ground.z() + 10);  // green or brown
  EXPECT_GT(sky.sum(), ground.sum() + 30);
}

TEST(Renderer, SameSceneTwiceIsTheSamePicture) {
  const DrawScene scene = support::wall_scene();
  Image first, second;
  {
    HeadlessRenderer renderer;
    first = renderer.render(scene, in_front(), still_frame(320, 180));
  }
  HeadlessRenderer renderer;
  renderer.render({}, in_front(), small());  // what was drawn before leaves no trace
  second = renderer.render(scene, in_front(), still_frame(320, 180));
  EXPECT_EQ(first.pixels, second.pixels);
}

TEST(Renderer, DrawsPlantsWhereTheCameraProjectsThem) {
  DrawScene scene;
  DrawTube post;
  post.points = {{0, 0, 0}, {0, 2, 0}};
  post.radii = {0.1, 0.1};
  post.color = {0.8, 0.02, 0.02};
  scene.tubes = {post};
  const Camera camera = Camera::parse("pivot 0 1 0 distance 5");
  HeadlessRenderer renderer;
  const Image image = renderer.render(scene, camera, small());
  const Vec3 on = camera.project({0, 1, 0}, 320, 180), beside = camera.project({0.2, 1, 0}, 320, 180);
  EXPECT_GT(pixel(image, on.x(), on.y()).x(), 2 * pixel(image, on.x(), on.y()).z());
  EXPECT_LT(pixel(image, beside.x(), beside.y()).x(), 2 * pixel(image, beside.x(), beside.y()).z());
}

TEST(Renderer, ObstaclesCastShadowsOnTheGround) {
  DrawScene scene;
  scene.meshes.push_back({support::box_mesh({-0.5, 2, -0.5}, {0.5, 2.2, 0.5}), {0.5, 0.5, 0.5}, false, ""});
  scene.to_sun = {0.5, 1, 0};
  const Camera camera = Camera::parse("pivot 0 0 0 distance 8 elevation 70");
  HeadlessRenderer renderer;
  const Image image = renderer.render(scene, camera, small());
  // The sun is towards +X, so the plate's shadow lies towards -X by half of its height.
  const Vec3 shade = camera.project({-1.05, 0, 0}, 320, 180), lit = camera.project({2, 0, 0}, 320, 180);
  EXPECT_LT(pixel(image, shade.x(), shade.y()).sum(), 0.75 * pixel(image, lit.x(), lit.y()).sum());
}

TEST(Renderer, LeafIsLitFromBothSides) {
  DrawScene scene;
  DrawLeaf leaf = support::leaf_at({0, 0.5, 0}, Vec3::UnitY(), Vec3::UnitZ(), 1);
  scene.leaves = {leaf};
  for (const double azimuth : {0.0, 180.0}) {
    scene.to_sun = {0, 0.3, 1};
    Camera camera = Camera::parse("pivot 0 1 0 distance 3");
    camera.azimuth = azimuth * kPi / 180;
    HeadlessRenderer renderer;
    const Image image = renderer.render(scene, camera, small());
    const Vec3 at = camera.project({0.1, 0.9, 0}, 320, 180), color = pixel(image, at.x(), at.y());
    EXPECT_GT(color.y(), 1.3 * color.z()) << azimuth;  // green, not black
    EXPECT_GT(color.y(), 60) << azimuth;
  }
}

TEST(Renderer, ImpossibleSizeIsAUsageError) {
  HeadlessRenderer renderer;
  for (const int side : {0, -3, 20000})
    EXPECT_THROW(renderer.render({}, {}, {.width = side, .height = 90}), Error);
}

}  // namespace
}  // namespace liana
