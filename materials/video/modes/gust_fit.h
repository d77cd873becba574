// Motion in gusty wind: frequencies and damping from the shape of its spectrum, with their uncertainty.
//
// An oscillator that random gusts push about has the autocovariance
//   R(τ) = s e^(−ξω|τ|) (cos ω_d τ + ξ/√(1−ξ²) sin ω_d |τ|),
// whose spectrum is the resonance curve of half-power width 2ξν. The record's spectrum is compared with the
// spectrum that such oscillators, slow gusts (e^(−|τ|/τ_w)) and white noise are expected to show in a record
// of this very length and window (the debiased Whittle likelihood, [Sykulski et al. 2019]), so that a
// resonance narrower than a bin is measured, too.
#pragma once

#include <span>
#include <vector>

#include "materials/video/modes/measured_mode.h"

namespace liana {

struct GustFit {
  std::vector<MeasuredMode> modes;  ///< the strongest first
  bool converged = false;
};

/// `starts`: frequencies (Hz) to start from, usually the peaks of the spectrum; they decide how many modes
/// there are. low, high: Hz, the part of the spectrum that is compared.
GustFit fit_gusts(std::span<const double> record, double dt, std::span<const double> starts, double low,
                  double high);

}  // namespace liana
