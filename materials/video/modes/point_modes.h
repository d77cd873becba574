// How one tracked point swings: its main direction, spectrum, frequencies and damping.
#pragma once

#include <string>
#include <vector>

#include "materials/video/modes/main_direction.h"
#include "materials/video/modes/measured_mode.h"
#include "materials/video/modes/spectrum.h"

namespace liana {

/// What set the plant in motion. FreeDecay: it was let go. Wind: it is pushed about all the time.
enum class Excitation { Auto, FreeDecay, Wind };

struct MotionOptions {
  double low = 0;   ///< Hz, lowest frequency asked for; 0: three swings of the record
  double high = 0;  ///< Hz, highest; 0: 0.4 of the frame rate
  double from = 0;  ///< s of the record; `to` = 0: to its end
  double to = 0;
  Excitation excitation = Excitation::Auto;
};

struct PointModes {
  std::string point;
  Excitation excitation = Excitation::Auto;  ///< FreeDecay or Wind: as which the motion was read
  size_t first_frame = 0, frames = 0;        ///< of the record, the part that was used
  size_t bridged = 0;                        ///< of them not seen
  Vec2 direction = Vec2::UnitX();            ///< of the main motion in the picture
  double direction_share = 1;                ///< of the motion's variance that lies along it
  double explained = 0;                      ///< share of the variance that a free decay takes up
  double lowest = 0, highest = 0;            ///< Hz, where was looked
  double resolution = 0;                     ///< Hz, one over the length of the part used
  std::vector<MeasuredMode> modes;           ///< the strongest first
  Spectrum spectrum;
};

/// [Wang17] §7: PCA to the main direction, FFT, key frequencies; beyond it, damping and uncertainty: by least
/// squares where the motion is a free decay (from its largest deflection on), else from the spectrum's shape.
/// Throws Error{Input} that names file and point when it is seen for too short a time for the lowest
/// frequency asked (and says how long is needed), hardly moves, or shows no frequency.
PointModes point_modes(const PointTracks& tracks, const PointTrack& track, const MotionOptions& options);

}  // namespace liana
