// Point tracks from a video file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "materials/video/tracks/point_tracks.h"
#include "mesher/base/progress.h"

namespace liana {

struct PickedPoint {
  std::string name;
  Vec2 at;  ///< pixels, x right, y down, in the first frame used
};

struct TrackOptions {
  std::vector<PickedPoint> points;
  size_t detect = 0;           ///< besides: this many that move most, found by the program
  bool steady_camera = false;  ///< it is known to be still (or still points are picked): nothing is taken out
  double from = 0, to = 0;     ///< s; to = 0: to the end
  double frames_per_second = 0;  ///< 0: what the file says
};

struct TrackedVideo {
  PointTracks seen;                 ///< where the points are in the frames
  PointTracks steady;               ///< the same, moved back by the camera's motion
  std::vector<Vec2> background;     ///< in the first frame: what the camera's motion was taken from
  double largest_camera_shift = 0;  ///< pixels, of the picture's centre
  std::vector<std::string> notes;
};

/// Throws Error{Input} when the file is no video, too short, or nothing in it moves; Error{Usage} for points
/// outside the picture; Error{Cancelled}.
TrackedVideo track_video(const std::filesystem::path& path, const TrackOptions& options, Progress& progress);

}  // namespace liana
