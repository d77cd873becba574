// The coefficients of the generalized-α method ([Chung & Hulbert 1993]) for a spectral radius ρ∞.
#pragma once

namespace liana {

struct GeneralizedAlpha {
  double alpha_m, alpha_f, gamma, beta;

  explicit GeneralizedAlpha(double rho_infinity)
      : alpha_m((2 * rho_infinity - 1) / (rho_infinity + 1)),
        alpha_f(rho_infinity / (rho_infinity + 1)),
        gamma(0.5 - alpha_m + alpha_f),
        beta(0.25 * (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f)) {}
};

}  // namespace liana
