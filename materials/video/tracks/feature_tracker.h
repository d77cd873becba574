// Points of the picture followed from frame to frame: corners [Shi & Tomasi 1994], pyramidal optical flow
// [Lucas & Kanade 1981], trusted only when it leads back to where it came from.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "materials/video/tracks/point_tracks.h"
#include "materials/video/tracks/video_reader.h"

namespace liana {

/// Corners from every part of the picture (so that a plain background is not outvoted by a plant full of
/// contrast), about `spacing` pixels apart.
std::vector<Vec2> good_features(const GrayFrame& frame, size_t most, double spacing);

/// The best corner within a distance of a point; nothing where the picture has no corner there.
std::optional<Vec2> feature_near(const GrayFrame& frame, const Vec2& point, double distance);

class FeatureTracker {
 public:
  FeatureTracker(const GrayFrame& first, const std::vector<Vec2>& points);
  ~FeatureTracker();
  /// Positions in the next frame, in the order of the points; NaN for those not found. A lost point is looked
  /// for again for half a dozen frames, from where it was seen last.
  std::vector<Vec2> advance(const GrayFrame& next);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace liana
