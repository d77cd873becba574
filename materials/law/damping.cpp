#include "materials/law/damping.h"

#include <algorithm>
#include <cmath>

namespace liana {

double modal_damping_factor(const RayleighDamping& damping, double frequency) {
  const double omega = 2 * kPi * frequency;
  return 0.5 * (damping.mass / omega + damping.stiffness * omega);
}

// The paper prints ν_low and ν_high as the values of the constant pieces; a damping factor is meant: ξ_low,
// ξ_high.
double damping_factor(const DampingLaw& law, double frequency) {
  if (law.constant_rayleigh)
    return modal_damping_factor({law.mass_damping, law.stiffness_damping}, frequency);
  if (frequency <= law.low_frequency) return law.low_factor;
  if (frequency >= law.high_frequency) return law.high_factor;
  const double slope = (law.high_factor - law.low_factor) / (law.high_frequency - law.low_frequency);
  return slope * (frequency - law.low_frequency) + law.low_factor;
}

RayleighDamping rayleigh_damping(const DampingLaw& law, double nu, double xi) {
  if (law.constant_rayleigh) return {law.mass_damping, law.stiffness_damping};
  const double kappa = law.kappa, delta = law.delta;
  const double divisor = kappa * kappa - 1;
  const double mass = 4 * kPi * nu * (kappa * kappa - kappa * delta) / divisor * xi;
  const double stiffness = (kappa * delta - 1) / (kPi * divisor * nu) * xi;
  // At the bounds of delta one of them is 0 but for rounding, which must not pump energy in.
  return {std::max(mass, 0.0), std::max(stiffness, 0.0)};
}

double least_damped_frequency(const DampingLaw& law, double nu) {
  if (law.constant_rayleigh) return std::sqrt(law.mass_damping / law.stiffness_damping) / (2 * kPi);
  const double kappa = law.kappa, delta = law.delta;
  return nu * std::sqrt((kappa * kappa - kappa * delta) / (kappa * delta - 1));
}

bool is_monotonic(const DampingLaw& law) {
  if (law.constant_rayleigh) return true;  // or not: nothing was asked of it at κν
  const double kappa = law.kappa, delta = law.delta;
  const double mean = (kappa * kappa + 1) / (2 * kappa);
  return (delta >= 1 / kappa && delta <= 1 / mean) || (delta >= mean && delta <= kappa);
}

}  // namespace liana
