// The smoothing kernels of [Müller, Charypar, Gross 2003], and what a wall of still air at rest density adds
// to them.
//
//   h     support radius, m                     W_poly6 = 315/(64π h⁹) (h²−r²)³        densities (their Eq.
//   20) d     distance from a plane wall, m         ∇W_spiky = −45/(π h⁶) (h−r)² x/r        pressure    (Eq.
//   21)
//                                               ∇²W_visc = 45/(π h⁶) (h−r)              viscosity   (Eq. 22)
#pragma once

#include <algorithm>

#include "mesher/base/fixed_math.h"
#include "mesher/base/types.h"

namespace liana {

inline double poly6_factor(double h) {
  return 315 / (64 * kPi * fixed::pow(h, 9));
}
inline double spiky_factor(double h) {
  return 45 / (kPi * fixed::pow(h, 6));
}

/// Integrals of the three kernels over the half space beyond a plane at distance d = q h, 0 <= q; a wall
/// counts as filled with air of rest density there, in closed form instead of by particles.
struct WallIntegrals {
  double density;    ///< ∫ W_poly6, of the rest density: 1/2 at the wall, 0 from h on
  double pressure;   ///< |∫ ∇W_spiky| h
  double viscosity;  ///< ∫ ∇²W_visc h²
};
inline WallIntegrals wall_integrals(double q) {
  if (q >= 1) return {0, 0, 0};
  q = std::max(q, 0.0);
  const double q2 = q * q, u = 1 - q, u4 = u * u * u * u;
  const double primitive = q * (1 + q2 * (-4.0 / 3 + q2 * (6.0 / 5 + q2 * (-4.0 / 7 + q2 / 9))));
  return {315.0 / 256 * (128.0 / 315 - primitive), 30 * u4 * (0.25 - u / 5),
          90 * (1.0 / 12 - q / 6 + q * q2 / 6 - q2 * q2 / 12)};
}

}  // namespace liana
