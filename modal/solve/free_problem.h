// (K + σ M)⁻¹ and M on the nodes that can move: what both eigensolvers are made of.
#pragma once

#include <span>

#include "modal/solve/cholesky.h"

namespace liana {

/// Its vectors have three rows for each node with free dof, in the order of elimination; held dof are zero.
/// To be used on the thread that made it.
class FreeProblem {
 public:
  /// Throws Error{Input} when all is held, or K + σ M is not positive definite.
  FreeProblem(const System& system, std::span<const uint8_t> held, double shift);

  int size() const { return matrix_.size(); }  ///< free dof
  Eigen::Index rows() const { return static_cast<Eigen::Index>(3 * matrix_.order.size()); }

  void multiply_mass(const NodalVectors& x, NodalVectors& y) const;
  /// x = (K + σ M)⁻¹ b
  void solve(const NodalVectors& b, NodalVectors& x);

  /// Uniform motion along each axis.
  NodalVectors translations() const;
  /// Uniform in [−1, 1], the same on every machine.
  NodalVectors noise(Eigen::Index columns, uint32_t seed) const;
  NodalVectors on_all_nodes(const NodalVectors& x, size_t system_nodes) const;

 private:
  FreeMatrix matrix_;
  Cholesky cholesky_;
  Eigen::MatrixXd buffer_;
};

}  // namespace liana
