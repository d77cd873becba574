// From the path of a point to one signal: gaps bridged, projected on the direction it moves in most.
#pragma once

#include <vector>

#include "materials/video/tracks/point_tracks.h"

namespace liana {

/// An unbroken part of a track.
struct Stretch {
  size_t first = 0;        ///< frame of the record
  std::vector<Vec2> path;  ///< pixels, finite
  size_t bridged = 0;      ///< frames that were not seen and lie on straight lines between their neighbours
};

/// The longest part of a track between `from` and `to` (frames, half open) without a gap of more than
/// `most_bridged` frames. Empty when the point is never seen.
Stretch longest_stretch(const PointTrack& track, size_t from, size_t to, size_t most_bridged);

struct MainDirection {
  Vec2 direction = Vec2::UnitX();  ///< unit, of the largest variance (PCA), pointing right (or down)
  double share = 1;                ///< of the variance that lies along it
  std::vector<double> signal;      ///< pixels along it, mean 0
};

MainDirection main_direction(const std::vector<Vec2>& path);

/// The path without what is slower than `lowest` Hz: a running mean weighted by a Gaussian whose response is
/// one half at lowest / 2, taken off (so that what swings at `lowest` keeps 94 % of its amplitude).
std::vector<Vec2> without_drift(const std::vector<Vec2>& path, double frames_per_second, double lowest);

}  // namespace liana
