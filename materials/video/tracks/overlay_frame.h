// What was tracked, drawn into the video's frames, to be looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "materials/video/tracks/track_video.h"
#include "materials/video/tracks/video_reader.h"

namespace liana {

/// RGB, width * height * 3: the frame in grey, background features as small crosses, every point as a ring
/// with its name and the way it came in the last second.
std::vector<uint8_t> overlay_frame(const GrayFrame& frame, const TrackedVideo& video, size_t index);

}  // namespace liana
