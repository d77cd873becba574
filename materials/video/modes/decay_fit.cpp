#include "materials/video/modes/decay_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "materials/video/modes/spectrum.h"
#include "mesher/base/types.h"

namespace liana {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// θ: for every mode log ω_d (1/s) and the decay rate a = ξω (1/s) in units of 1/T.
struct Model {
  const VectorXd& y;
  double dt;

  double seconds() const { return dt * static_cast<double>(y.size()); }
  MatrixXd shapes(const VectorXd& theta) const {
    const Index modes = theta.size() / 2;
    MatrixXd Phi(y.size(), 2 * modes + 2);
    for (Index n = 0; n < y.size(); ++n) {
      const double t = dt * static_cast<double>(n);
      Phi(n, 2 * modes) = 1;
      Phi(n, 2 * modes + 1) = t / seconds() - 0.5;
      for (Index k = 0; k < modes; ++k) {
        // A growth beyond e^20 is no decay: bounded only to stay finite while the search strays.
        const double envelope = std::exp(std::min(20.0, -theta[2 * k + 1] * t / seconds()));
        const double phase = std::exp(theta[2 * k]) * t;
        Phi(n, 2 * k) = envelope * std::cos(phase);
        Phi(n, 2 * k + 1) = envelope * std::sin(phase);
      }
    }
    return Phi;
  }
};

// Variable projection: what is left when the linear coefficients are the best ones.
struct Residual {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Model model;
  Index unknowns;

  Index inputs() const { return unknowns; }
  Index values() const { return model.y.size(); }
  VectorXd at(const VectorXd& theta) const {
    const MatrixXd Phi = model.shapes(theta);
    const Eigen::HouseholderQR<MatrixXd> qr(Phi);
    VectorXd projected = qr.householderQ().transpose() * model.y;
    projected.head(Phi.cols()).setZero();
    return qr.householderQ() * projected;
  }
  int operator()(const VectorXd& theta, VectorXd& left) const {
    left = at(theta);
    return left.allFinite() ? 0 : -1;
  }
  /// Kaufman's Jacobian: what the shapes' change with θ leaves outside their span.
  int df(const VectorXd& theta, MatrixXd& J) const {
    const MatrixXd Phi = model.shapes(theta);
    const Eigen::HouseholderQR<MatrixXd> qr(Phi);
    const VectorXd c = qr.solve(model.y);
    MatrixXd change(values(), inputs());
    for (Index k = 0; k < theta.size() / 2; ++k) {
      const VectorXd swing = c[2 * k] * Phi.col(2 * k) + c[2 * k + 1] * Phi.col(2 * k + 1);
      const VectorXd ahead = c[2 * k + 1] * Phi.col(2 * k) - c[2 * k] * Phi.col(2 * k + 1);  // a quarter turn
      const double turn = std::exp(theta[2 * k]);
      for (Index n = 0; n < values(); ++n) {
        const double t = model.dt * static_cast<double>(n);
        change(n, 2 * k) = turn * t * ahead[n];
        change(n, 2 * k + 1) = -t / model.seconds() * swing[n];
      }
    }
    MatrixXd projected = qr.householderQ().transpose() * change;
    projected.topRows(Phi.cols()).setZero();
    J = -(qr.householderQ() * projected);
    return J.allFinite() ? 0 : -1;
  }
};

VectorXd refined(const Residual& residual, VectorXd theta) {
  Eigen::LevenbergMarquardt<Residual> search(const_cast<Residual&>(residual));
  search.parameters.maxfev = 60;
  search.parameters.xtol = search.parameters.ftol = 1e-9;
  search.minimize(theta);
  return theta;
}

VectorXd with_mode(const VectorXd& theta, double frequency) {
  VectorXd more(theta.size() + 2);
  constexpr double kDecay = 2;  // e-folds over the record to start the search from
  more << theta, std::log(2 * kPi * frequency), kDecay;
  return more;
}

/// Two modes nearer than the record's resolution would only share out one.
bool is_apart(const Model& model, const VectorXd& theta, double frequency) {
  for (Index k = 0; k < theta.size() / 2; ++k)
    if (std::abs(std::exp(theta[2 * k]) / (2 * kPi) - frequency) * model.seconds() < 1) return false;
  return true;
}
bool are_apart(const Model& model, const VectorXd& theta) {
  for (Index k = 0; k < theta.size() / 2; ++k)
    if (!is_apart(model, theta.head(2 * k), std::exp(theta[2 * k]) / (2 * kPi))) return false;
  return true;
}

std::vector<double> to_vector(const VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

MeasuredMode mode_of(const Model& model, const VectorXd& theta, Index k, const MatrixXd& normal_inverse,
                     double noise_power) {
  const double T = model.seconds(), turn = std::exp(theta[2 * k]), a = theta[2 * k + 1] / T;
  const double omega = std::hypot(turn, a);
  MeasuredMode mode;
  mode.frequency = omega / (2 * kPi);
  mode.damping_factor = a / omega;
  // ν and ξ by (log ω_d, a T).
  Eigen::Matrix2d D;
  D << turn * turn / omega / (2 * kPi), a / omega / (2 * kPi) / T,  //
      -a * turn * turn / std::pow(omega, 3), turn * turn / std::pow(omega, 3) / T;
  const Eigen::Matrix2d covariance =
      noise_power * D * normal_inverse.block<2, 2>(2 * k, 2 * k) * D.transpose();
  mode.frequency_sigma = std::sqrt(covariance(0, 0));
  mode.damping_sigma = std::sqrt(covariance(1, 1));
  return mode;
}

}  // namespace

DecayFit fit_decay(std::span<const double> record, double dt, const DecayOptions& options) {
  DecayFit fit;
  const auto count = static_cast<Index>(record.size());
  const VectorXd y = Eigen::Map<const VectorXd>(record.data(), count);
  const Model model{y, dt};
  VectorXd theta(0), left = Residual{model, 0}.at(theta);
  const double all = left.squaredNorm();
  if (all <= 0) return fit;

  constexpr double kStandsOut =
      12;  // times the median power: white noise of 1000 bins does so in 1 of 10 records
  constexpr double kNothingLeft = 1e-10;
  while (theta.size() < 2 * options.most_modes && left.squaredNorm() > kNothingLeft * all) {
    if (count < 4 * theta.size() + 20) break;
    const auto peaks = spectrum_peaks(power_spectrum(to_vector(left), dt, Window::None), options.low,
                                      options.high, theta.size() == 0 ? 0 : kStandsOut);
    const auto next = std::find_if(peaks.begin(), peaks.end(), [&](const SpectrumPeak& peak) {
      return is_apart(model, theta, peak.frequency);
    });
    if (next == peaks.end()) break;
    const VectorXd more = with_mode(theta, next->frequency);
    const Residual residual{model, more.size()};
    const VectorXd better = refined(residual, more);
    const VectorXd rest = residual.at(better);
    // Bayes' information criterion: four more numbers.
    const double worth = std::exp(-4 * std::log(static_cast<double>(count)) / static_cast<double>(count));
    if (!rest.allFinite() || rest.squaredNorm() > worth * left.squaredNorm() || !are_apart(model, better))
      break;
    theta = better, left = rest;
  }
  fit.explained = 1 - left.squaredNorm() / all;
  if (theta.size() == 0) return fit;

  const Residual residual{model, theta.size()};
  MatrixXd J;
  residual.df(theta, J);
  const MatrixXd normal_inverse = (J.transpose() * J).completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd Phi = model.shapes(theta);
  const VectorXd coefficients = Phi.colPivHouseholderQr().solve(y);
  const Spectrum noise = power_spectrum(to_vector(left), dt, Window::None, 2);
  const double freedom =
      static_cast<double>(count) / static_cast<double>(std::max<Index>(1, count - 2 * theta.size() - 2));
  for (Index k = 0; k < theta.size() / 2; ++k) {
    const double frequency = std::exp(theta[2 * k]) / (2 * kPi), reach = 3 / model.seconds();
    const double white = left.squaredNorm() / static_cast<double>(count);
    const double noise_power =
        freedom * std::max(white, noise.local_mean(frequency - reach, frequency + reach));
    MeasuredMode mode = mode_of(model, theta, k, normal_inverse, noise_power);
    mode.amplitude = coefficients.segment<2>(2 * k).norm();
    const double energy = (Phi.middleCols<2>(2 * k) * coefficients.segment<2>(2 * k)).squaredNorm();
    const bool determined = mode.frequency_sigma < 0.2 * mode.frequency && energy > 9 * noise_power;
    const bool inside =
        mode.frequency >= options.low && mode.frequency <= options.high && mode.damping_factor < 0.95;
    if (determined && inside && std::isfinite(mode.damping_sigma)) fit.modes.push_back(mode);
  }
  std::sort(fit.modes.begin(), fit.modes.end(),
            [](const MeasuredMode& a, const MeasuredMode& b) { return a.amplitude > b.amplitude; });
  return fit;
}

}  // namespace liana
