// Points in a video whose camera shakes: drawn by formula, so that every position is known.
#include "materials/video/tracks/track_video.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/video/modes/point_modes.h"
#include "mesher/base/random.h"
#include "mesher/base/types.h"
#include "runtime/view/video.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

constexpr int kWidth = 320, kHeight = 240, kFrames = 150;
constexpr double kFps = 25, kFrequency = 1.4, kDamping = 0.05;

/// Smooth noise: waves of 10 to 30 pixels in random directions.
class Texture {
 public:
  explicit Texture(std::string_view name) {
    Random random(1, name);
    for (Wave& wave : waves_) {
      const double angle = random.uniform(0, 2 * kPi), number = 2 * kPi / random.uniform(10, 30);
      wave = {number * Vec2(std::cos(angle), std::sin(angle)), random.uniform(0, 2 * kPi)};
    }
  }
  double at(const Vec2& p) const {  // about -1 to 1
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.number.dot(p) + wave.phase);
    return sum / 3;
  }

 private:
  struct Wave {
    Vec2 number;
    double phase;
  };
  Wave waves_[6];
};

Vec2 swing(int frame) {
  const double t = frame / kFps, omega = 2 * kPi * kFrequency;
  return Vec2(12, 5) * std::exp(-kDamping * omega * t) *
         std::cos(omega * std::sqrt(1 - kDamping * kDamping) * t);
}

/// A patch of leaves swings before a wall; the hand shifts and turns the camera by up to 20 pixels and 1°.
void film(const std::filesystem::path& path, bool shaken) {
  const Texture wall("wall"), leaves("leaves");
  Random random(2, "hand");
  VideoWriter writer(path, kWidth, kHeight, kFps);
  Vec2 hand = Vec2::Zero();
  double turn = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (shaken && frame > 0) {
      hand = 0.97 * hand + 1.5 * Vec2(random.normal(), random.normal());
      turn = 0.95 * turn + 0.002 * random.normal();
    }
    const Eigen::Rotation2D<double> camera(turn);
    Image image{kWidth, kHeight, {}};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const Vec2 world = camera * (Vec2(x, y) - Vec2(160, 120)) + Vec2(160, 120) + hand;
        const Vec2 in_patch = world - Vec2(170, 110) - swing(frame);
        const double inside = 1 / (1 + std::exp(in_patch.norm() - 28));  // soft edge: no aliasing
        const double gray =
            (1 - inside) * (110 + 40 * wall.at(world)) + inside * (150 + 80 * leaves.at(in_patch));
        image.pixels.insert(image.pixels.end(), 3, static_cast<uint8_t>(std::clamp(gray, 0.0, 255.0)));
      }
    writer.add(image);
  }
  writer.finish();
}

TEST(TrackVideo, ShakenCameraIsTakenOutAndTheSwingRemains) {
  const ScratchFolder folder;
  film(folder / "shaken.mp4", true);
  Progress silent;
  const TrackedVideo video = track_video(folder / "shaken.mp4", {.points = {{"P", {182, 115}}}}, silent);
  EXPECT_EQ(video.steady.frames_per_second, kFps);
  ASSERT_EQ(video.steady.frames(), size_t{kFrames});
  EXPECT_GT(video.largest_camera_shift, 5);
  double worst = 0;
  const PointTrack& track = video.steady.points.front();
  for (int frame = 0; frame < kFrames; ++frame) {
    ASSERT_TRUE(track.seen(size_t(frame))) << frame;
    worst = std::max(worst, ((track.path[size_t(frame)] - track.path[0]) - (swing(frame) - swing(0))).norm());
  }
  EXPECT_LT(worst, 1);  // pixel: a tenth a frame that adds up, and the background's own tenth
  const PointModes motion = point_modes(video.steady, track, {});
  EXPECT_EQ(motion.excitation, Excitation::FreeDecay);
  EXPECT_NEAR(motion.modes.front().frequency, kFrequency, 0.01 * kFrequency);
  EXPECT_NEAR(motion.modes.front().damping_factor, kDamping, 0.1 * kDamping);
}

TEST(TrackVideo, StillCameraIsRecognisedAndWhatMovesIsFound) {
  const ScratchFolder folder;
  film(folder / "steady.mp4", false);
  Progress silent;
  const TrackedVideo video = track_video(folder / "steady.mp4", {.points = {}, .detect = 3}, silent);
  EXPECT_EQ(video.largest_camera_shift, 0);
  ASSERT_EQ(video.steady.points.size(), 3u);
  for (const PointTrack& track : video.steady.points) {
    EXPECT_LT((track.path[0] - Vec2(170, 110) - swing(0)).norm(), 36) << track.name;
    EXPECT_NEAR(point_modes(video.steady, track, {}).modes.front().frequency, kFrequency, 0.01 * kFrequency)
        << track.name;
  }
}

}  // namespace
}  // namespace liana
