// One oscillation found in a record.
#pragma once

namespace liana {

struct MeasuredMode {
  double frequency = 0;        ///< ν, Hz, of the undamped oscillator
  double frequency_sigma = 0;  ///< Hz, one standard deviation
  double damping_factor = 0;   ///< ξ
  double damping_sigma = 0;
  double amplitude = 0;  ///< pixels: at the start of a free decay; root mean square of a motion in gusts
};

/// 95 % of a normal distribution lie within this many standard deviations.
constexpr double kCoverage95 = 1.96;

}  // namespace liana
