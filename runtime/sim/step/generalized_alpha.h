// The coefficients of the generalized-α method ([Chung & Hulbert 1993]) for a spectral radius ρ∞.
#pragma once

namespace liana {

struct GeneralizedAlpha {
  double alpha_m, alpha_f, gamma, beta;
  /// x₁ = x₀ + h v₀ + h² (before a₀ + beta a₁)
  double before;

  explicit GeneralizedAlpha(double rho_infinity)
      : alpha_m((2 * rho_infinity - 1) / (rho_infinity + 1)),
        alpha_f(rho_infinity / (rho_infinity + 1)),
        gamma(0.5 - alpha_m + alpha_f),
        beta(0.25 * (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f)),
        before(0.5 - beta) {}

  /// Backward Euler in the same terms: remembers no acceleration. Of first order, L-stable, and the last to
  /// lose its way.
  static GeneralizedAlpha backward_euler() {
    GeneralizedAlpha method(0);
    method.alpha_m = method.alpha_f = method.before = 0;
    method.gamma = method.beta = 1;
    return method;
  }
};

}  // namespace liana
