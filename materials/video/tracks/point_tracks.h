// Where points of a filmed plant were in every frame.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace liana {

using Vec2 = Eigen::Vector2d;

struct PointTrack {
  std::string name;
  std::vector<Vec2> path;  ///< pixels, one per frame of the record; NaN where the point was not seen

  bool seen(size_t frame) const { return path[frame].allFinite(); }
};

struct PointTracks {
  std::string source;  ///< the file, for messages
  double frames_per_second = 0;
  int64_t first_frame = 0;         ///< number that the file gives to path[0]
  std::vector<PointTrack> points;  ///< all paths are equally long

  size_t frames() const { return points.empty() ? 0 : points.front().path.size(); }
  double seconds() const { return static_cast<double>(frames()) / frames_per_second; }
  /// Throws Error{Usage} that names the nearest point and all others.
  const PointTrack& point(const std::string& name) const;
};

/// CSV with the columns frame, point, x, y (a header may order them otherwise and add more; lines that start
/// with # are skipped). Frames that are left out, and an empty or "nan" x or y, mean "not seen". Throws
/// Error{Input} "file:line: ..." for anything else that is no such table: text where a number must be, frames
/// of a point that do not increase, coordinates beyond 1e6 pixels, more than 2e6 positions.
PointTracks parse_point_tracks(std::string_view text, const std::string& file, double frames_per_second);
PointTracks read_point_tracks(const std::filesystem::path& path, double frames_per_second);

/// What parse_point_tracks reads.
std::string point_tracks_csv(const PointTracks& tracks);

}  // namespace liana
