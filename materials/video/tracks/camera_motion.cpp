#include "materials/video/tracks/camera_motion.h"

#include <algorithm>
#include <limits>

#include "materials/video/tracks/similarity.h"

namespace liana {
PointTracks without_camera_motion(const PointTracks& tracks, const std::vector<std::string>& still_points) {
  if (still_points.empty()) return tracks;
  struct Still {
    const PointTrack* track;
    Vec2 reference;
  };
  std::vector<Still> still;
  for (const std::string& name : still_points) {
    const PointTrack& track = tracks.point(name);
    const auto first =
        std::find_if(track.path.begin(), track.path.end(), [](const Vec2& p) { return p.allFinite(); });
    if (first != track.path.end()) still.push_back({&track, *first});
  }
  PointTracks steady = tracks;
  std::erase_if(steady.points, [&](const PointTrack& track) {
    return std::find(still_points.begin(), still_points.end(), track.name) != still_points.end();
  });
  for (size_t frame = 0; frame < tracks.frames(); ++frame) {
    std::vector<Vec2> now, reference;
    for (const Still& s : still)
      if (s.track->seen(frame)) now.push_back(s.track->path[frame]), reference.push_back(s.reference);
    for (PointTrack& track : steady.points)
      track.path[frame] = now.empty() ? Vec2::Constant(std::numeric_limits<double>::quiet_NaN())
                                      : Vec2(least_squares_similarity(now, reference) * track.path[frame]);
  }
  return steady;
}

}  // namespace liana
