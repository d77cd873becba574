#include "modal/subspace_iteration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "modal/cholesky.h"

namespace liana {
namespace {

using Dense = Eigen::MatrixXd;

/// Sway values this many times the lowest bring nothing to the lowest modes: their vectors start again at
/// random. Between a round rod's pair (1) and its second bending mode (39).
constexpr double kFarAbove = 4;

/// Uniform in [−1, 1], the same for the same key on every machine.
double noise(uint32_t row, uint32_t column) {
  const uint32_t key[2] = {row, column};
  return 2 * (hash_bytes(key, sizeof key) >> 11) * 0x1p-53 - 1;
}

class SubspaceIteration {
 public:
  SubspaceIteration(const System& system, std::span<const uint8_t> held, const EigenOptions& options)
      : system_(system),
        options_(options),
        matrix_(free_matrix(system, held, options.shift)),
        cholesky_(matrix_) {
    if (matrix_.size() < 3)
      throw Error(Error::Kind::Input, "the solid has no free nodes: all of it is held",
                  "hold only the root interface");
    if (!cholesky_.positive_definite())
      throw Error(
          Error::Kind::Input,
          "the stiffness matrix is singular: the solid is not held, or too thin (below 1/5000 of its length)",
          "hold it on a face, or make it thicker");
  }

  EigenResult run() {
    EigenResult result;
    result.dof = static_cast<uint32_t>(matrix_.size());
    const int modes = std::min(options_.modes, matrix_.size());
    const int width = std::min(std::max(3, modes + (modes + 1) / 2), matrix_.size());
    start_vectors(width);
    for (result.iterations = 1; result.iterations <= options_.max_iterations; ++result.iterations) {
      solve();
      Y_mass_ = system_.multiply_mass(Y_);
      if (result.iterations == 1 && can_sway_) sway(result);
      rayleigh_ritz(result, std::min<int>(modes, X_.cols()));
      if (X_.cols() >= modes && result.residual < options_.tolerance) {
        result.converged = true;
        break;
      }
      if (result.iterations == 1 && can_sway_) refresh_far_vectors(modes, result);
    }
    result.eigenvalues = eigenvalues_.head(modes).array() - options_.shift;
    result.vectors = X_.leftCols(modes);
    return result;
  }

 private:
  NodalVectors random_vectors(int columns, uint32_t seed) const {
    NodalVectors x = NodalVectors::Zero(3 * system_.nodes(), columns);
    for (const uint32_t dof : matrix_.dof)
      for (int c = 0; c < columns; ++c) x(dof, c) = noise(dof, seed + c);
    return x;
  }

  void start_vectors(int width) {
    X_ = random_vectors(width, 0);
    NodalVectors translations = NodalVectors::Zero(X_.rows(), 3);
    for (const uint32_t dof : matrix_.dof) translations(dof, dof % 3) = 1;
    can_sway_ = (translations.colwise().squaredNorm().array() > 0).all();
    for (int c = 0; c < 3; ++c)  // an axis that is held everywhere starts at random
      if (translations.col(c).squaredNorm() > 0) X_.col(c) = translations.col(c);
    X_mass_ = system_.multiply_mass(X_);
  }

  /// Y = (K + σ M)⁻¹ M X
  void solve() {
    buffer_.resize(matrix_.size(), X_.cols());
    for (int i = 0; i < matrix_.size(); ++i) buffer_.row(i) = X_mass_.row(matrix_.dof[i]);
    cholesky_.solve(buffer_);
    Y_.setZero(X_.rows(), X_.cols());
    for (int i = 0; i < matrix_.size(); ++i) Y_.row(matrix_.dof[i]) = buffer_.row(i);
  }

  void sway(EigenResult& result) const {
    const Mat3 A = Y_.leftCols<3>().transpose() * X_mass_.leftCols<3>();
    const Mat3 B = Y_.leftCols<3>().transpose() * Y_mass_.leftCols<3>();
    Eigen::GeneralizedSelfAdjointEigenSolver<Mat3> ritz((A + A.transpose()) / 2, (B + B.transpose()) / 2);
    if (ritz.info() != Eigen::Success) return;
    result.sway_eigenvalues = ritz.eigenvalues().array() - options_.shift;
    for (int i = 0; i < 3; ++i) result.sway_directions.col(i) = (A * ritz.eigenvectors().col(i)).normalized();
  }

  /// On the span of Y: Yᵀ K Y = Yᵀ M X by construction, so K is never multiplied.
  void rayleigh_ritz(EigenResult& result, int modes) {
    // Columns of one size keep the small matrices well conditioned.
    Eigen::VectorXd scale = Y_.cwiseProduct(Y_mass_).colwise().sum().transpose().cwiseSqrt().cwiseInverse();
    Dense A = scale.asDiagonal() * Dense(Y_.transpose() * X_mass_) * scale.asDiagonal();
    Dense B = scale.asDiagonal() * Dense(Y_.transpose() * Y_mass_) * scale.asDiagonal();
    A = (A + A.transpose()).eval() / 2;
    B = (B + B.transpose()).eval() / 2;
    Eigen::GeneralizedSelfAdjointEigenSolver<Dense> ritz(A, B);
    if (ritz.info() != Eigen::Success)
      throw Error(Error::Kind::Input, "the mass matrix is not positive definite");
    eigenvalues_ = ritz.eigenvalues();
    const Dense rotation = scale.asDiagonal() * ritz.eigenvectors();
    const NodalVectors stiffness_x = X_mass_ * rotation;
    X_ = Y_ * rotation;
    X_mass_ = Y_mass_ * rotation;
    result.residual = 0;
    for (int c = 0; c < modes; ++c) {
      double difference = 0, size = 0;
      for (const uint32_t dof : matrix_.dof) {
        const double k = stiffness_x(dof, c), r = k - eigenvalues_[c] * X_mass_(dof, c);
        difference += r * r, size += k * k;
      }
      result.residual = std::max(result.residual, std::sqrt(difference / size));
    }
  }

  /// After the first step: a round rod goes on with its pair of bending vectors; otherwise the stiff sways
  /// give way to random vectors. A little noise in the others, so that no symmetry hides a mode from them.
  void refresh_far_vectors(int modes, const EigenResult& result) {
    int near = 1;
    while (near < 3 && result.sway_eigenvalues[near] < kFarAbove * result.sway_eigenvalues[0]) ++near;
    if (modes <= near && X_.cols() == 3 && near >= 2) {
      X_ = X_.leftCols(near).eval();
    }
    const NodalVectors random = random_vectors(static_cast<int>(X_.cols()), 1000);
    for (int c = 0; c < X_.cols(); ++c) {
      if (c >= near && c < 3)
        X_.col(c) = random.col(c);
      else
        X_.col(c) += 1e-3 * X_.col(c).lpNorm<Eigen::Infinity>() * random.col(c);
    }
    X_mass_ = system_.multiply_mass(X_);
  }

  const System& system_;
  EigenOptions options_;
  FreeMatrix matrix_;
  Cholesky cholesky_;
  NodalVectors X_, X_mass_, Y_, Y_mass_;
  Dense buffer_;
  Eigen::VectorXd eigenvalues_;
  bool can_sway_ = false;  // no axis is held everywhere
};

}  // namespace

EigenResult lowest_eigenpairs(const System& system, std::span<const uint8_t> held,
                              const EigenOptions& options) {
  require(held.size() == 3 * system.nodes(), "held must have one entry a dof");
  return SubspaceIteration(system, held, options).run();
}

}  // namespace liana
