// Frequency and damping of a recorded, freely decaying motion.
#pragma once

#include <span>

namespace liana {

struct DampedSinusoid {
  double frequency = 0;       ///< Hz, of the undamped oscillator: |λ| / 2π
  double damping_factor = 0;  ///< ξ = −Re λ / |λ|
  double residual = 1;        ///< rms of what the fit leaves, over the rms of the record
  bool found = false;         ///< false when no part of the record oscillates
};

/// The strongest oscillation e^(λt) in a record sampled every dt seconds: a matrix pencil ([Hua & Sarkar
/// 1990]) of few exponentials over a few swings. Parts of the record that decay away or swing otherwise are
/// fitted and left out. Nothing is assumed of frequency or damping but that a swing takes more than two
/// samples.
DampedSinusoid fit_damped_sinusoid(std::span<const double> record, double dt);

}  // namespace liana
