// L Lᵀ of a sparse symmetric positive definite matrix that is already well ordered, and solves with it.
#pragma once

#include <memory>

#include "modal/solve/free_matrix.h"

namespace liana {

/// CHOLMOD with one workspace a thread: an object must be used on the thread that made it.
class Cholesky {
 public:
  explicit Cholesky(const FreeMatrix& matrix);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  bool positive_definite() const;
  /// Replaces each column b (matrix.size() entries) by A⁻¹ b.
  void solve(Eigen::MatrixXd& b) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace liana
