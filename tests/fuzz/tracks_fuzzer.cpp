// parse_point_tracks on any bytes: a table of finite or missing positions, or an Error.
#include <cmath>

#include "materials/video/tracks/point_tracks.h"
#include "mesher/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const liana::PointTracks tracks =
        liana::parse_point_tracks({reinterpret_cast<const char*>(data), size}, "fuzz.csv", 30);
    for (const liana::PointTrack& track : tracks.points) {
      liana::require(track.path.size() == tracks.frames(), "paths are equally long");
      for (const liana::Vec2& p : track.path)
        for (const double x : {p.x(), p.y()})
          liana::require(std::isnan(x) || std::abs(x) <= 1e6, "positions are in the picture or unknown");
    }
  } catch (const liana::Error&) {
  }
  return 0;
}
