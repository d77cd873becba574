#include "runtime/sim/check/damped_sinusoid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <complex>
#include <vector>

#include "mesher/base/types.h"

namespace liana {
namespace {

using Complex = std::complex<double>;

// Samples between sign changes tell how densely the record can be thinned out: to about 12 a swing.
// Neighbouring samples of a slow swing are nearly equal, and their pencil would be as ill-conditioned.
size_t thinning(std::span<const double> record) {
  size_t first = 0, last = 0, changes = 0;
  for (size_t i = 1; i < record.size(); ++i) {
    if ((record[i] < 0) == (record[i - 1] < 0)) continue;
    if (changes++ == 0) first = i;
    last = i;
  }
  const double swing = changes > 1
                           ? 2.0 * static_cast<double>(last - first) / static_cast<double>(changes - 1)
                           : static_cast<double>(record.size()) / 4;
  return std::max<size_t>(1, static_cast<size_t>(swing / 12));
}

// The z of y_n = Σ c z^n: eigenvalues of the pencil (Y₂, Y₁) of two shifted Hankel matrices, in the space of
// the singular vectors that carry the signal.
Eigen::VectorXcd poles(const Eigen::VectorXd& y) {
  constexpr int kMostPoles = 8;    // one swing, the step's own real root, and a few higher modes
  constexpr double kNoise = 1e-7;  // smaller singular values are rounding and what is not linear
  const Eigen::Index pencil = y.size() / 2, rows = y.size() - pencil;
  Eigen::MatrixXd Y(rows, pencil + 1);
  for (Eigen::Index i = 0; i < rows; ++i) Y.row(i) = y.segment(i, pencil + 1);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(Y, Eigen::ComputeThinV);
  const auto& s = svd.singularValues();
  Eigen::Index order = 0;
  while (order < std::min<Eigen::Index>({kMostPoles, s.size(), pencil}) && s[order] > kNoise * s[0]) ++order;
  const Eigen::MatrixXd V = svd.matrixV().leftCols(order);
  const Eigen::MatrixXd shift = V.topRows(pencil).colPivHouseholderQr().solve(V.bottomRows(pencil));
  return Eigen::EigenSolver<Eigen::MatrixXd>(shift, false).eigenvalues();
}

}  // namespace

DampedSinusoid fit_damped_sinusoid(std::span<const double> record, double dt) {
  constexpr size_t kSamples = 72;  // six swings of twelve
  DampedSinusoid fit;
  if (record.size() < 8) return fit;
  const size_t step = thinning(record), count = std::min(kSamples, (record.size() - 1) / step + 1);
  if (count < 8) return fit;
  Eigen::VectorXd y(static_cast<Eigen::Index>(count));
  for (size_t i = 0; i < count; ++i) y[static_cast<Eigen::Index>(i)] = record[i * step];
  if (!y.allFinite() || y.norm() == 0) return fit;

  const Eigen::VectorXcd z = poles(y);
  Eigen::MatrixXcd powers(y.size(), z.size());
  for (Eigen::Index k = 0; k < z.size(); ++k)
    for (Eigen::Index n = 0; n < y.size(); ++n) powers(n, k) = std::pow(z[k], static_cast<double>(n));
  const Eigen::VectorXcd amplitude = powers.colPivHouseholderQr().solve(y.cast<Complex>());
  fit.residual = (powers * amplitude - y.cast<Complex>()).norm() / y.norm();

  double strongest = 0;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const double energy = (powers.col(k) * amplitude[k]).squaredNorm();
    if (z[k].imag() <= 1e-9 || energy <= strongest) continue;
    strongest = energy;
    const Complex lambda = std::log(z[k]) / (dt * static_cast<double>(step));
    fit.frequency = std::abs(lambda) / (2 * kPi);
    fit.damping_factor = -lambda.real() / std::abs(lambda);
    fit.found = true;
  }
  return fit;
}

}  // namespace liana
