// Free decay: damped sinusoids fitted to a record by least squares, with their uncertainty.
//
// y(t) = c₀ + c₁ t + Σ e^(−ξωt) (A cos ω_d t + B sin ω_d t) + noise, ω = 2πν, ω_d = ω √(1 − ξ²).
#pragma once

#include <span>
#include <vector>

#include "materials/video/modes/measured_mode.h"

namespace liana {

struct DecayFit {
  std::vector<MeasuredMode> modes;  ///< the strongest first
  double explained = 0;             ///< share of the record's variance that the fit takes up
};

struct DecayOptions {
  double low = 0, high = 0;  ///< Hz: where frequencies are looked for
  int most_modes = 6;
};

/// Modes are taken from the spectrum of what is left, one by one, as long as one stands out; all are refitted
/// each time (variable projection, [Golub & Pereyra 1973]). Standard deviations are those of least squares
/// with the noise's power near the mode's own frequency, so that noise which is not white (wind, drift of a
/// tracked point) is not mistaken for less than it is. Modes that are not determined (deviation above a fifth
/// of the frequency or amplitude below three times the noise's share) are left out.
DecayFit fit_decay(std::span<const double> record, double dt, const DecayOptions& options);

}  // namespace liana
