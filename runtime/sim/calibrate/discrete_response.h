// What one time step makes of x'' + c x' + k x = 0, and its inverse: which k and c the step turns into a
// given frequency and damping factor.
//
// Symbols: h step (s); ω = 2πν; ξ damping factor; z what the motion is multiplied with in one step. Wanted is
// z* = exp((−ξ ω + i ω √(1−ξ²)) h). For a motion x_n = X zⁿ, v_n = V zⁿ, a_n = zⁿ generalized-α says
//   h V = h² ((1−γ) + γ z) / (z−1),   X = (h V + h² ((½−β) + β z)) / (z−1)
//   ((1−α_m) z + α_m) + ((1−α_f) z + α_f) (c V + k X) = 0
// which is linear in (k, c): two real equations, no iteration.
#pragma once

#include "mesher/base/types.h"

namespace liana {

struct UnitOscillator {
  double stiffness;  ///< k*, 1/s²
  double damping;    ///< c*, 1/s
  bool in_range =
      true;  ///< false: the step cannot do it with k > 0 and c ≥ 0; k and c are then the nearest it can
};

/// The oscillator that a step of length h with this ρ∞ moves at `frequency` (Hz, > 0) with `damping_factor`
/// (≥ 0).
UnitOscillator discrete_oscillator(double frequency, double damping_factor, double h, double rho_infinity);

/// The step as a matrix acting on (x, v h, a h²), for checking the above and for tests.
Mat3 amplification_matrix(double stiffness, double damping, double h, double rho_infinity);

}  // namespace liana
