#include "runtime/sim/calibrate/discrete_response.h"

#include <algorithm>
#include <complex>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/step/generalized_alpha.h"

namespace liana {
namespace {

using Complex = std::complex<double>;

/// Compilers' own libraries divide in ways of their own.
Complex quotient(const Complex& a, const Complex& b) {
  return a * std::conj(b) / std::norm(b);
}

UnitOscillator invert(double frequency, double damping_factor, double h, double rho_infinity) {
  const auto [alpha_m, alpha_f, gamma, beta, before] = GeneralizedAlpha(rho_infinity);
  const double omega = 2 * kPi * frequency, xi = damping_factor;
  const double turn = omega * std::sqrt(1 - xi * xi) * h;
  const Complex z = fixed::exp(-xi * omega * h) * Complex(fixed::cos(turn), fixed::sin(turn));
  const Complex V = h * quotient((1 - gamma) + gamma * z, z - 1.0);
  const Complex X = quotient(h * V + h * h * ((0.5 - beta) + beta * z), z - 1.0);
  const Complex r = -quotient((1 - alpha_m) * z + alpha_m, (1 - alpha_f) * z + alpha_f);  // c V + k X = r
  const double determinant = V.real() * X.imag() - V.imag() * X.real();
  UnitOscillator o;
  o.damping = (r.real() * X.imag() - r.imag() * X.real()) / determinant;
  o.stiffness = (V.real() * r.imag() - V.imag() * r.real()) / determinant;
  return o;
}

}  // namespace

UnitOscillator discrete_oscillator(double frequency, double damping_factor, double h, double rho_infinity) {
  // Fastest turn that is told from a slower one with room to spare: 0.9 of half a turn per step.
  const double fastest = 0.45 / h;
  const double xi = std::clamp(damping_factor, 0.0, 0.98);
  UnitOscillator o = invert(std::min(frequency, fastest), xi, h, rho_infinity);
  // A target with next to no damping may ask for a little less than nothing. Without it the branch has at
  // most ξ = 5e-5 too much, which no bake can tell; ρ∞ = 1, which would give it none, lets stiff directions
  // ring until it swings up.
  constexpr double kUnseen = 5e-5;
  const double least = -2 * kUnseen * std::sqrt(std::max(o.stiffness, 0.0));
  o.in_range = frequency <= fastest && xi == damping_factor && o.stiffness > 0 && o.damping >= least;
  if (o.stiffness <= 0) o.stiffness = fixed::pow(2 * kPi * std::min(frequency, fastest), 2);
  o.damping = std::max(o.damping, 0.0);
  return o;
}

Mat3 amplification_matrix(double k, double c, double h, double rho_infinity) {
  const auto [alpha_m, alpha_f, gamma, beta, before] = GeneralizedAlpha(rho_infinity);
  const double K = k * h * h, C = c * h;
  // x₁ = x + v + (½−β) a + β a₁,  v₁ = v + (1−γ) a + γ a₁  (in units of h), and the balance solved for a₁.
  const Eigen::RowVector3d x(1, 1, 0.5 - beta), v(0, 1, 1 - gamma);
  const Eigen::RowVector3d x0(1, 0, 0), v0(0, 1, 0), a0(0, 0, 1);
  const double implicit = 1 - alpha_m + (1 - alpha_f) * (gamma * C + beta * K);
  const Eigen::RowVector3d a1 =
      -(alpha_m * a0 + C * ((1 - alpha_f) * v + alpha_f * v0) + K * ((1 - alpha_f) * x + alpha_f * x0)) /
      implicit;
  Mat3 A;
  A << x + beta * a1, v + gamma * a1, a1;
  return A;
}

}  // namespace liana
