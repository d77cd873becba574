// The best eigenpairs within the span of a few vectors, and how good they are.
#pragma once

#include "modal/solve/eigenpairs.h"

namespace liana {

/// aᵀ b of two tall arrays with few columns.
Eigen::MatrixXd gram(const NodalVectors& a, const NodalVectors& b);

struct RitzPairs {
  Eigen::VectorXd values;    ///< ascending
  Eigen::MatrixXd rotation;  ///< the vectors: Y times this, M-normalised
};

/// Of A x = λ B x, both small and symmetric: only their lower triangles are read. Throws Error{Input} when B
/// is not positive definite.
RitzPairs small_eigenpairs(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// On the span of Y = A⁻¹ M X: Yᵀ A Y = Yᵀ M X by construction, so A is never multiplied. Throws Error{Input}
/// when M is not positive definite on it.
RitzPairs rayleigh_ritz(const NodalVectors& X_mass, const NodalVectors& Y, const NodalVectors& Y_mass);

/// Max over the first `modes` columns of |λ Y − X| / |X| by the M-norm, with Y = A⁻¹ M X.
double largest_change(const NodalVectors& X, const NodalVectors& X_mass, const NodalVectors& Y,
                      const NodalVectors& Y_mass, const Eigen::VectorXd& eigenvalues, Eigen::Index modes);

/// The sways of EigenResult from Y = A⁻¹ M X, the deflections under uniform acceleration X along each axis.
void find_sways(const NodalVectors& X_mass, const NodalVectors& Y, const NodalVectors& Y_mass,
                EigenResult& result);

}  // namespace liana
