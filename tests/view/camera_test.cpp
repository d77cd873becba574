#include "runtime/picture/camera.h"

#include <gtest/gtest.h>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr double kRounding = 1e-12;  // a few hundred ulps of lengths of a few metres

Camera slanted() {
  return Camera::parse("pivot 0.3 1.2 -0.5 distance 4 azimuth 35 elevation 20");
}

TEST(Camera, PanMovesThePivotAndKeepsTheDistance) {
  Camera camera = slanted();
  const Vec3 before = camera.pivot, way = camera.forward();
  camera.pan(40, -25, kHeight);
  EXPECT_EQ(camera.distance, 4);
  EXPECT_NEAR((camera.pivot - before).dot(way), 0, kRounding);
  // The old pivot is now 40 pixels to the right of the middle and 25 above it.
  const Vec3 pixel = camera.project(before, kWidth, kHeight);
  EXPECT_NEAR(pixel.x(), kWidth / 2 + 40, 1e-9);
  EXPECT_NEAR(pixel.y(), kHeight / 2 - 25, 1e-9);
}

TEST(Camera, ZoomIsRelativeToTheDistance) {
  Camera near_one = slanted(), far_one = slanted();
  far_one.distance = 40;
  near_one.zoom(3);
  far_one.zoom(3);
  EXPECT_NEAR(far_one.distance / near_one.distance, 10, kRounding);
  EXPECT_LT(near_one.distance, 4);
  near_one.zoom(-3);
  EXPECT_NEAR(near_one.distance, 4, kRounding);
}

TEST(Camera, OrbitKeepsPivotDistanceAndHorizon) {
  Camera camera = slanted();
  camera.orbit(123, 1e5, kHeight);  // far over the pole
  EXPECT_EQ(camera.pivot, slanted().pivot);
  EXPECT_NEAR((camera.eye() - camera.pivot).norm(), 4, kRounding);
  EXPECT_NEAR(camera.right().y(), 0, kRounding);
  EXPECT_GT(camera.up().y(), 0);  // never upside down
}

TEST(Camera, RayOfAPixelMeetsThePointProjectedThere) {
  const Camera camera = slanted();
  const Vec3 point(0.9, 0.4, 0.1);
  const Vec3 pixel = camera.project(point, kWidth, kHeight);
  const Ray ray = camera.ray(pixel.x(), pixel.y(), kWidth, kHeight);
  EXPECT_NEAR(ray.direction.cross(point - ray.origin).norm(), 0, 1e-9);
}

TEST(Camera, MatricesAgreeWithProject) {
  const Camera camera = slanted();
  const Vec3 point(0.9, 0.4, 0.1), pixel = camera.project(point, kWidth, kHeight);
  const glm::vec4 clip = camera.projection(double(kWidth) / kHeight) * camera.view() *
                         glm::vec4(point.x(), point.y(), point.z(), 1);
  // Single precision: 1e-6 of the picture's width.
  EXPECT_NEAR((clip.x / clip.w + 1) / 2 * kWidth, pixel.x(), 1e-2);
  EXPECT_NEAR((1 - clip.y / clip.w) / 2 * kHeight, pixel.y(), 1e-2);
}

TEST(Camera, FrameShowsEveryCornerAndFillsThePicture) {
  Camera camera = slanted();
  BoundingBox box;
  box.add({-3, 0, 1});
  box.add({5, 2, 1.5});
  camera.frame(box, double(kWidth) / kHeight);
  double widest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 point(corner & 1 ? box.high.x() : box.low.x(), corner & 2 ? box.high.y() : box.low.y(),
                     corner & 4 ? box.high.z() : box.low.z());
    const Vec3 pixel = camera.project(point, kWidth, kHeight);
    EXPECT_GT(pixel.z(), 0);
    const double x = std::abs(2 * pixel.x() / kWidth - 1), y = std::abs(2 * pixel.y() / kHeight - 1);
    widest = std::max({widest, x, y});
  }
  EXPECT_LE(widest, 1);
  EXPECT_GE(widest, 0.85);
}

TEST(Camera, PoseSurvivesAsText) {
  const Camera camera = slanted(), read = Camera::parse(camera.text());
  EXPECT_NEAR((read.eye() - camera.eye()).norm(), 0, 1e-3);  // text() keeps four digits
  EXPECT_EQ(read.text(), camera.text());
}

TEST(Camera, BadPoseNamesTheWord) {
  for (const char* text : {"pivot 1 2", "distance near", "roll 3", "azimuth nan", "distance 1e"}) {
    try {
      Camera::parse(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Usage);
      EXPECT_FALSE(error.hint.empty());
    }
  }
}

}  // namespace
}  // namespace liana
