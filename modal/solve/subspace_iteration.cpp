#include "modal/solve/subspace_iteration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "modal/solve/cholesky.h"

namespace liana {
namespace {

using Dense = Eigen::MatrixXd;

/// Sway values this many times the lowest bring nothing to the lowest modes: their vectors start again at
/// random. Between a round rod's pair (1) and its second bending mode (39).
constexpr double kFarAbove = 4;

/// A step never counts for more than this: what it removes first are the components far above, and those that
/// remain shrink less.
constexpr double kBestContraction = 0.03;

/// Uniform in [−1, 1], the same for the same key on every machine.
double noise(uint32_t row, uint32_t column) {
  const uint32_t key[2] = {row, column};
  return 2 * (hash_bytes(key, sizeof key) >> 11) * 0x1p-53 - 1;
}

/// aᵀ b of two tall arrays with few columns.
Dense gram(const NodalVectors& a, const NodalVectors& b) {
  Dense sum = Dense::Zero(a.cols(), b.cols());
  for (Eigen::Index r = 0; r < a.rows(); ++r)
    for (Eigen::Index j = 0; j < b.cols(); ++j)
      for (Eigen::Index i = 0; i < a.cols(); ++i) sum(i, j) += a(r, i) * b(r, j);
  return sum;
}

/// Vectors have three rows for each node with free dof, in the order of elimination; held dof are zero.
class SubspaceIteration {
 public:
  SubspaceIteration(const System& system, std::span<const uint8_t> held, const EigenOptions& options)
      : options_(options), matrix_(free_matrix(system, held, options.shift)), cholesky_(matrix_) {
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
    double last_change = std::numeric_limits<double>::infinity();
    for (result.iterations = 1; result.iterations <= options_.max_iterations; ++result.iterations) {
      solve();
      multiply_mass(Y_, Y_mass_);
      const bool first = result.iterations == 1;
      if (first && can_sway_) sway(result);
      if (!first && X_.cols() >= modes) {
        const double change = largest_change(modes);
        result.residual = change * std::clamp(change / last_change, kBestContraction, 1.0);
        last_change = change;
      }
      rayleigh_ritz();
      if (!first && X_.cols() >= modes && result.residual < options_.tolerance) {
        result.converged = true;
        break;
      }
      if (first && can_sway_) refresh_far_vectors(modes, result);
    }
    result.eigenvalues = eigenvalues_.head(modes).array() - options_.shift;
    return result;
  }

  /// The vectors of run() on all nodes of the system.
  NodalVectors vectors(size_t system_nodes, Eigen::Index modes) const {
    NodalVectors all = NodalVectors::Zero(3 * system_nodes, modes);
    for (size_t p = 0; p < matrix_.order.size(); ++p)
      all.middleRows<3>(3 * matrix_.order[p]) = X_.block(3 * p, 0, 3, modes);
    return all;
  }

 private:
  NodalVectors random_vectors(Eigen::Index columns, uint32_t seed) const {
    NodalVectors x = NodalVectors::Zero(3 * matrix_.order.size(), columns);
    for (int i = 0; i < matrix_.size(); ++i)
      for (Eigen::Index c = 0; c < columns; ++c) x(matrix_.slot[i], c) = noise(matrix_.dof[i], seed + c);
    return x;
  }

  void start_vectors(int width) {
    NodalVectors translations = NodalVectors::Zero(3 * matrix_.order.size(), 3);
    for (const uint32_t slot : matrix_.slot) translations(slot, slot % 3) = 1;
    can_sway_ = (translations.colwise().squaredNorm().array() > 0).all();
    if (can_sway_ && width == 3) {
      X_ = translations;
    } else {
      X_ = random_vectors(width, 0);
      for (int c = 0; c < 3; ++c)  // an axis that is held everywhere starts at random
        if (translations.col(c).squaredNorm() > 0) X_.col(c) = translations.col(c);
    }
    multiply_mass(X_, X_mass_);
  }

  void multiply_mass(const NodalVectors& x, NodalVectors& y) const {
    y.setZero(x.rows(), x.cols());
    const Eigen::Index width = 3 * x.cols();
    const Pattern& lower = matrix_.lower_nodes;
    for (int j = 0; j < lower.size(); ++j) {
      const double* xj = x.data() + j * width;
      double* yj = y.data() + j * width;
      for (int e = lower.start[j]; e < lower.start[j + 1]; ++e) {
        const double m = matrix_.mass[e];
        const int i = lower.row[e];
        const double* xi = x.data() + i * width;
        double* yi = y.data() + i * width;
        for (Eigen::Index k = 0; k < width; ++k) yi[k] += m * xj[k];
        if (i == j) continue;
        for (Eigen::Index k = 0; k < width; ++k) yj[k] += m * xi[k];
      }
    }
    if (matrix_.whole_nodes) return;
    std::vector<uint8_t> is_free(y.rows(), 0);
    for (const uint32_t slot : matrix_.slot) is_free[slot] = 1;
    for (Eigen::Index r = 0; r < y.rows(); ++r)
      if (!is_free[r]) y.row(r).setZero();
  }

  /// Y = (K + σ M)⁻¹ M X
  void solve() {
    buffer_.resize(matrix_.size(), X_.cols());
    for (int i = 0; i < matrix_.size(); ++i) buffer_.row(i) = X_mass_.row(matrix_.slot[i]);
    cholesky_.solve(buffer_);
    Y_.setZero(X_.rows(), X_.cols());
    for (int i = 0; i < matrix_.size(); ++i) Y_.row(matrix_.slot[i]) = buffer_.row(i);
  }

  void sway(EigenResult& result) const {
    const Mat3 A = gram(Y_.leftCols<3>(), X_mass_.leftCols<3>());
    const Mat3 B = gram(Y_.leftCols<3>(), Y_mass_.leftCols<3>());
    Eigen::GeneralizedSelfAdjointEigenSolver<Mat3> ritz((A + A.transpose()) / 2, (B + B.transpose()) / 2);
    if (ritz.info() != Eigen::Success) return;
    result.sway_eigenvalues = ritz.eigenvalues().array() - options_.shift;
    for (int i = 0; i < 3; ++i) result.sway_directions.col(i) = (A * ritz.eigenvectors().col(i)).normalized();
  }

  /// Max over modes of |λ Y − X| / |X| by the M-norm.
  double largest_change(int modes) const {
    double largest = 0;
    for (int c = 0; c < modes; ++c) {
      double change = 0, size = 0;
      for (Eigen::Index r = 0; r < X_.rows(); ++r) {
        const double x = X_(r, c), mx = X_mass_(r, c), lambda = eigenvalues_[c];
        change += (lambda * Y_(r, c) - x) * (lambda * Y_mass_(r, c) - mx);
        size += x * mx;
      }
      largest = std::max(largest, std::sqrt(std::max(0.0, change / size)));
    }
    return largest;
  }

  /// On the span of Y: Yᵀ K Y = Yᵀ M X by construction, so K is never multiplied.
  void rayleigh_ritz() {
    // Columns of one size keep the small matrices well conditioned.
    Dense A = gram(Y_, X_mass_), B = gram(Y_, Y_mass_);
    const Eigen::VectorXd scale = B.diagonal().cwiseSqrt().cwiseInverse();
    A = scale.asDiagonal() * (A + A.transpose()).eval() * scale.asDiagonal() / 2;
    B = scale.asDiagonal() * (B + B.transpose()).eval() * scale.asDiagonal() / 2;
    Eigen::GeneralizedSelfAdjointEigenSolver<Dense> ritz(A, B);
    if (ritz.info() != Eigen::Success)
      throw Error(Error::Kind::Input, "the mass matrix is not positive definite");
    eigenvalues_ = ritz.eigenvalues();
    const Dense rotation = scale.asDiagonal() * ritz.eigenvectors();
    X_.noalias() = Y_.lazyProduct(rotation);
    X_mass_.noalias() = Y_mass_.lazyProduct(rotation);
  }

  /// After the first step: a round rod goes on with its pair of bending vectors; otherwise the stiff sways
  /// give way to random vectors. A little noise in the others, so that no symmetry hides a mode from them.
  void refresh_far_vectors(int modes, const EigenResult& result) {
    int near = 1;
    while (near < 3 && result.sway_eigenvalues[near] < kFarAbove * result.sway_eigenvalues[0]) ++near;
    if (modes <= near && X_.cols() == 3 && near >= 2) {
      X_ = X_.leftCols(near).eval();
    }
    const NodalVectors random = random_vectors(X_.cols(), 1000);
    for (int c = 0; c < X_.cols(); ++c) {
      if (c >= near && c < 3)
        X_.col(c) = random.col(c);
      else
        X_.col(c) += 1e-3 * X_.col(c).lpNorm<Eigen::Infinity>() * random.col(c);
    }
    multiply_mass(X_, X_mass_);
  }

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
  SubspaceIteration iteration(system, held, options);
  EigenResult result = iteration.run();
  result.vectors = iteration.vectors(system.nodes(), result.eigenvalues.size());
  return result;
}

}  // namespace liana
