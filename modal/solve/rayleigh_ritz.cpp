#include "modal/solve/rayleigh_ritz.h"

#include <Eigen/Eigenvalues>

#include "mesher/base/error.h"

namespace liana {

Eigen::MatrixXd gram(const NodalVectors& a, const NodalVectors& b) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (Eigen::Index r = 0; r < a.rows(); ++r)
    for (Eigen::Index j = 0; j < b.cols(); ++j)
      for (Eigen::Index i = 0; i < a.cols(); ++i) sum(i, j) += a(r, i) * b(r, j);
  return sum;
}

RitzPairs small_eigenpairs(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(A, B);
  if (ritz.info() != Eigen::Success)
    throw Error(Error::Kind::Input, "the mass matrix is not positive definite");
  return {ritz.eigenvalues(), ritz.eigenvectors()};
}

RitzPairs rayleigh_ritz(const NodalVectors& X_mass, const NodalVectors& Y, const NodalVectors& Y_mass) {
  // Columns of one size keep the small matrices well conditioned.
  Eigen::MatrixXd A = gram(Y, X_mass), B = gram(Y, Y_mass);
  const Eigen::VectorXd scale = B.diagonal().cwiseSqrt().cwiseInverse();
  A = scale.asDiagonal() * (A + A.transpose()).eval() * scale.asDiagonal() / 2;
  B = scale.asDiagonal() * (B + B.transpose()).eval() * scale.asDiagonal() / 2;
  RitzPairs pairs = small_eigenpairs(A, B);
  pairs.rotation = scale.asDiagonal() * pairs.rotation;
  return pairs;
}

double largest_change(const NodalVectors& X, const NodalVectors& X_mass, const NodalVectors& Y,
                      const NodalVectors& Y_mass, const Eigen::VectorXd& eigenvalues, Eigen::Index modes) {
  double largest = 0;
  for (Eigen::Index c = 0; c < modes; ++c) {
    double change = 0, size = 0;
    for (Eigen::Index r = 0; r < X.rows(); ++r) {
      const double x = X(r, c), mx = X_mass(r, c), lambda = eigenvalues[c];
      change += (lambda * Y(r, c) - x) * (lambda * Y_mass(r, c) - mx);
      size += x * mx;
    }
    largest = std::max(largest, std::sqrt(std::max(0.0, change / size)));
  }
  return largest;
}

void find_sways(const NodalVectors& X_mass, const NodalVectors& Y, const NodalVectors& Y_mass,
                EigenResult& result) {
  const Mat3 A = gram(Y.leftCols<3>(), X_mass.leftCols<3>());
  const Mat3 B = gram(Y.leftCols<3>(), Y_mass.leftCols<3>());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat3> ritz((A + A.transpose()) / 2, (B + B.transpose()) / 2);
  if (ritz.info() != Eigen::Success) return;
  result.sway_eigenvalues = ritz.eigenvalues();
  for (int i = 0; i < 3; ++i) result.sway_directions.col(i) = (A * ritz.eigenvectors().col(i)).normalized();
}

}  // namespace liana
