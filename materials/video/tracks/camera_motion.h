// A hand-held camera's own motion, seen in points that do not move.
#pragma once

#include <string>
#include <vector>

#include "materials/video/tracks/point_tracks.h"

namespace liana {

/// Moves every frame back so that the still points rest where they were in the first frame that sees them:
/// shift for one still point, shift, turn and zoom (least squares) for more. The still points
/// are taken out. Frames in which no still point is seen become "not seen". Throws Error{Usage} for an
/// unknown name.
PointTracks without_camera_motion(const PointTracks& tracks, const std::vector<std::string>& still_points);

}  // namespace liana
