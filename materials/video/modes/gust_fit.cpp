#include "materials/video/modes/gust_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "materials/video/modes/spectrum.h"
#include "mesher/base/types.h"

namespace liana {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Neighbouring bins under a Hann window are correlated: powers by 4/9, next but one by 1/36. A sum over bins
// therefore varies 1 + 2 (4/9 + 1/36) times as much as one over independent bins.
constexpr double kHannCorrelation = 35.0 / 18;

/// θ: log s, log ν, log ξ of every mode, then log power and log time of the gusts, then log power of the
/// noise.
class ExpectedSpectrum {
 public:
  ExpectedSpectrum(size_t count, double dt, double low, double high)
      : dt_(dt), size_(std::bit_ceil(2 * count)) {
    const std::vector<double> window = hann_window(count);
    overlap_.resize(count);  // w ⋆ w, which the expectation multiplies the autocovariance with
    auto bins = fourier(window, size_);
    std::vector<double> power;
    for (const auto& z : bins) power.push_back(std::norm(z));
    for (size_t i = size_ / 2 - 1; i > 0; --i) power.push_back(power[i]);
    const auto back = fourier(power, size_);  // even and real: forward is backward
    for (size_t lag = 0; lag < count; ++lag)
      overlap_[lag] = back[std::min(lag, size_ - lag)].real() / static_cast<double>(size_);
    // One bin per 1/T: between them the padded spectrum holds nothing new.
    const double bin = 1 / (dt * static_cast<double>(count));
    for (auto k = static_cast<size_t>(std::max(1.0, std::ceil(low / bin)));
         static_cast<double>(k) * bin <= high; ++k)
      frequencies_.push_back(static_cast<double>(k) * bin);
  }

  const std::vector<double>& frequencies() const { return frequencies_; }

  VectorXd sample(const std::vector<double>& padded_power) const {
    VectorXd values(static_cast<Index>(frequencies_.size()));
    const double bin = 1 / (dt_ * static_cast<double>(2 * (padded_power.size() - 1)));
    const Spectrum spectrum{bin, padded_power};
    for (size_t i = 0; i < frequencies_.size(); ++i)
      values[static_cast<Index>(i)] = spectrum.at(frequencies_[i]);
    return values;
  }

  VectorXd mode(double s, double nu, double xi) const {
    const double omega = 2 * kPi * nu, root = std::sqrt(std::max(1e-9, 1 - xi * xi)), turn = omega * root;
    return of_covariance([&](double t) {
      return s * std::exp(-xi * omega * t) * (std::cos(turn * t) + xi / root * std::sin(turn * t));
    });
  }
  VectorXd gusts(double s, double time) const {
    return of_covariance([&](double t) { return s * std::exp(-t / time); });
  }
  size_t padded_size() const { return 4 * size_; }

 private:
  template <class Covariance>
  VectorXd of_covariance(Covariance&& R) const {
    // Twice the one-sided sum, less the value at 0: the transform of an even sequence is real.
    std::vector<double> product(overlap_.size());
    for (size_t lag = 0; lag < overlap_.size(); ++lag)
      product[lag] = (lag == 0 ? 1 : 2) * overlap_[lag] * R(dt_ * static_cast<double>(lag));
    std::vector<double> power;
    for (const auto& z : fourier(product, padded_size())) power.push_back(std::max(0.0, z.real()));
    return sample(power);
  }

  double dt_;
  size_t size_;
  std::vector<double> overlap_, frequencies_;
};

class Likelihood {
 public:
  Likelihood(const ExpectedSpectrum& expected, VectorXd measured, Index modes)
      : expected_(expected), measured_(std::move(measured)), modes_(modes) {}

  VectorXd part(const VectorXd& theta, Index k) const {  // k = modes_: the gusts
    if (k < modes_)
      return expected_.mode(std::exp(theta[3 * k]), std::exp(theta[3 * k + 1]),
                            std::min(0.99, std::exp(theta[3 * k + 2])));
    return expected_.gusts(std::exp(theta[3 * modes_]), std::exp(theta[3 * modes_ + 1]));
  }
  std::vector<VectorXd> parts(const VectorXd& theta) const {
    std::vector<VectorXd> all;
    for (Index k = 0; k <= modes_; ++k) all.push_back(part(theta, k));
    all.push_back(VectorXd::Constant(measured_.size(), std::exp(theta[theta.size() - 1])));
    return all;
  }
  static VectorXd sum(const std::vector<VectorXd>& parts) {
    VectorXd S = parts.front();
    for (size_t i = 1; i < parts.size(); ++i) S += parts[i];
    return S;
  }
  /// −log likelihood (Whittle): Σ log S + I/S, and weak priors that keep ξ and the gusts' time in this world.
  double cost(const VectorXd& theta, const VectorXd& S) const {
    return (S.array().log() + measured_.array() / S.array()).sum() + prior(theta);
  }
  double prior(const VectorXd& theta) const {
    double sum = 0;
    for (Index k = 0; k < modes_; ++k) sum += 0.5 * square((theta[3 * k + 2] - kLogXi) / kXiSpread);
    return sum + 0.5 * square(theta[3 * modes_ + 1] / 2);  // gusts of 1 s, e² either way
  }
  /// Fisher information and downhill direction.
  void slope(const VectorXd& theta, const std::vector<VectorXd>& parts, const VectorXd& S, VectorXd& g,
             MatrixXd& F) const {
    MatrixXd D(measured_.size(), theta.size());
    for (Index j = 0; j < theta.size(); ++j) {
      const bool noise = j == theta.size() - 1;
      const Index k = noise ? modes_ + 1 : j / 3;
      const bool power = noise || (j % 3 == 0);
      if (power) {
        D.col(j) = parts[static_cast<size_t>(k)].cwiseQuotient(S);  // ∂ log S by the log of a power
      } else {
        constexpr double kStep = 1e-4;
        VectorXd other = theta;
        other[j] += kStep;
        D.col(j) = (part(other, k) - parts[static_cast<size_t>(k)]).cwiseQuotient(S) / kStep;
      }
    }
    g = D.transpose() * (measured_.cwiseQuotient(S) - VectorXd::Ones(S.size()));
    F = D.transpose() * D;
    for (Index k = 0; k < modes_; ++k) {
      g[3 * k + 2] -= (theta[3 * k + 2] - kLogXi) / square(kXiSpread);
      F(3 * k + 2, 3 * k + 2) += 1 / square(kXiSpread);
    }
    g[3 * modes_ + 1] -= theta[3 * modes_ + 1] / 4;
    F(3 * modes_ + 1, 3 * modes_ + 1) += 0.25;
  }

 private:
  static double square(double x) { return x * x; }
  static constexpr double kLogXi = -3.0;  // log 0.05: plants lie between 0.005 and 0.5
  static constexpr double kXiSpread = 1.2;

  const ExpectedSpectrum& expected_;
  VectorXd measured_;
  Index modes_;
};

struct Solution {
  VectorXd theta;
  MatrixXd information;  // Fisher
  double cost = std::numeric_limits<double>::infinity();
  bool converged = false;
};

/// Fisher scoring with the step damped as in Levenberg-Marquardt.
Solution maximised(const Likelihood& likelihood, VectorXd theta) {
  auto parts = likelihood.parts(theta);
  VectorXd S = Likelihood::sum(parts), g;
  Solution solution;
  double cost = likelihood.cost(theta, S), damping = 1;
  constexpr double kStuck = 1e9;
  for (int round = 0; round < 100 && damping < kStuck; ++round) {
    likelihood.slope(theta, parts, S, g, solution.information);
    MatrixXd A = solution.information;
    A.diagonal() *= 1 + damping;
    A.diagonal().array() += 1e-9;
    const VectorXd next = theta + A.ldlt().solve(g).cwiseMax(-1.0).cwiseMin(1.0);
    auto next_parts = likelihood.parts(next);
    const VectorXd next_S = Likelihood::sum(next_parts);
    const double next_cost = likelihood.cost(next, next_S);
    if (!(std::isfinite(next_cost) && next_cost <= cost)) {
      damping *= 4;
      continue;
    }
    const double gain = cost - next_cost;
    theta = next, parts = std::move(next_parts), S = next_S, cost = next_cost;
    damping = std::max(1e-6, damping / 5);
    if (gain < 1e-5) {
      solution.converged = true;
      break;
    }
  }
  solution.converged |= damping >= kStuck;  // no step lowers the cost any more
  likelihood.slope(theta, parts, S, g, solution.information);
  solution.theta = theta, solution.cost = cost;
  return solution;
}

/// log s, log ν, log ξ of a mode whose peak has the measured height.
Eigen::Vector3d start_of(double nu, const ExpectedSpectrum& expected, const VectorXd& measured, double dt,
                         double T) {
  const auto& f = expected.frequencies();
  const auto at = static_cast<Index>(std::lower_bound(f.begin(), f.end(), nu) - f.begin());
  const Index first = std::clamp<Index>(at - 2, 0, measured.size() - 1),
              last = std::min(measured.size() - 1, at + 2);
  const double power = measured.segment(first, last - first + 1).mean(), xi = 0.05;
  const double width = std::max(2 * kPi * nu * xi, 1 / T);  // the peak of a unit mode is about 1/(ξω dt) high
  return {std::log(power * width * dt), std::log(nu), std::log(xi)};
}

}  // namespace

GustFit fit_gusts(std::span<const double> record, double dt, std::span<const double> starts, double low,
                  double high) {
  GustFit fit;
  const ExpectedSpectrum expected(record.size(), dt, low, high);
  const size_t padding = (expected.padded_size() + record.size() - 1) / record.size();
  const VectorXd measured = expected.sample(power_spectrum(record, dt, Window::Hann, padding).power);
  if (measured.size() < 8 || !(measured.minCoeff() > 0)) return fit;
  VectorXd sorted = measured;
  std::sort(sorted.begin(), sorted.end());
  const double floor = sorted[sorted.size() / 4], T = dt * static_cast<double>(record.size());

  // One mode after another, the strongest first; one that the record does not ask for (Bayes' information
  // criterion: three more numbers, of as many bins as are independent) is left out.
  const double price = 1.5 * std::log(static_cast<double>(measured.size())) * kHannCorrelation;
  Solution best;
  Index modes = 0;
  for (const double start : starts) {
    if (measured.size() < 3 * (modes + 1) + 4) break;
    VectorXd theta(3 * modes + 6);
    if (modes > 0)
      theta.head(3 * modes) = best.theta.head(3 * modes), theta.tail<3>() = best.theta.tail<3>();
    else
      theta.tail<3>() << std::log(std::max(floor, measured[0]) * dt), 0, std::log(floor);
    theta.segment<3>(3 * modes) = start_of(start, expected, measured, dt, T);
    const Solution more = maximised(Likelihood(expected, measured, modes + 1), theta);
    if (modes > 0 && more.cost > best.cost - price) continue;
    best = more;
    ++modes;
  }
  if (modes == 0) return fit;
  fit.converged = best.converged;
  const VectorXd& theta = best.theta;
  const MatrixXd covariance =
      kHannCorrelation * best.information.completeOrthogonalDecomposition().pseudoInverse();
  for (Index k = 0; k < modes; ++k) {
    MeasuredMode mode;
    mode.frequency = std::exp(theta[3 * k + 1]);
    mode.damping_factor = std::min(0.99, std::exp(theta[3 * k + 2]));
    mode.amplitude = std::exp(theta[3 * k] / 2);
    mode.frequency_sigma = mode.frequency * std::sqrt(std::max(0.0, covariance(3 * k + 1, 3 * k + 1)));
    mode.damping_sigma = mode.damping_factor * std::sqrt(std::max(0.0, covariance(3 * k + 2, 3 * k + 2)));
    const bool determined = mode.frequency_sigma < 0.2 * mode.frequency && mode.frequency_sigma > 0;
    if (determined && mode.frequency > low && mode.frequency < high) fit.modes.push_back(mode);
  }
  std::sort(fit.modes.begin(), fit.modes.end(),
            [](const MeasuredMode& a, const MeasuredMode& b) { return a.amplitude > b.amplitude; });
  return fit;
}

}  // namespace liana
