// Push one branch off, let the simulator move it, and measure how it swings.
#pragma once

#include "runtime/sim/calibrate/held_chain.h"
#include "runtime/sim/check/damped_sinusoid.h"

namespace liana {

struct ProbeOptions {
  double amplitude = 1e-3;  ///< of the tip, over the chain's length: small, so that the motion is linear
  int least_steps = 40;
  int most_steps = 8000;
  int swings = 7;  ///< recorded before it stops, unless the motion dies out first
};

struct ProbeResult {
  DampedSinusoid swing;
  int steps = 0;
};

/// Bends the chain into its lowest mode, lets go, and steps it with the plant's own stepper and scheme,
/// without gravity. Frequency and damping come from the tip's recorded motion alone. `chain`: after
/// lowest_eigenvalue().
ProbeResult probe(const HeldChain& chain, const ProbeOptions& options = {});

}  // namespace liana
