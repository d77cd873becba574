#include "modal/solve/free_problem.h"

#include "mesher/base/error.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

double noise_at(uint32_t row, uint32_t column) {
  const uint32_t key[2] = {row, column};
  return 2 * (hash_bytes(key, sizeof key) >> 11) * 0x1p-53 - 1;
}

}  // namespace

FreeProblem::FreeProblem(const System& system, std::span<const uint8_t> held, double shift)
    : matrix_(free_matrix(system, held, shift)), cholesky_(matrix_) {
  if (matrix_.size() < 3)
    throw Error(Error::Kind::Input, "the solid has no free nodes: all of it is held",
                "hold only the root interface");
  if (!cholesky_.positive_definite())
    throw Error(
        Error::Kind::Input,
        "the stiffness matrix is singular: the solid is not held, or too thin (below 1/5000 of its length)",
        "hold it on a face, or make it thicker");
}

void FreeProblem::multiply_mass(const NodalVectors& x, NodalVectors& y) const {
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

void FreeProblem::solve(const NodalVectors& b, NodalVectors& x) {
  buffer_.resize(matrix_.size(), b.cols());
  for (int i = 0; i < matrix_.size(); ++i) buffer_.row(i) = b.row(matrix_.slot[i]);
  cholesky_.solve(buffer_);
  x.setZero(b.rows(), b.cols());
  for (int i = 0; i < matrix_.size(); ++i) x.row(matrix_.slot[i]) = buffer_.row(i);
}

NodalVectors FreeProblem::translations() const {
  NodalVectors x = NodalVectors::Zero(rows(), 3);
  for (const uint32_t slot : matrix_.slot) x(slot, slot % 3) = 1;
  return x;
}

NodalVectors FreeProblem::noise(Eigen::Index columns, uint32_t seed) const {
  NodalVectors x = NodalVectors::Zero(rows(), columns);
  for (int i = 0; i < matrix_.size(); ++i)
    for (Eigen::Index c = 0; c < columns; ++c)
      x(matrix_.slot[i], c) = noise_at(matrix_.dof[i], seed + static_cast<uint32_t>(c));
  return x;
}

NodalVectors FreeProblem::on_all_nodes(const NodalVectors& x, size_t system_nodes) const {
  NodalVectors all = NodalVectors::Zero(3 * system_nodes, x.cols());
  for (size_t p = 0; p < matrix_.order.size(); ++p)
    all.middleRows<3>(3 * matrix_.order[p]) = x.middleRows<3>(3 * p);
  return all;
}

}  // namespace liana
