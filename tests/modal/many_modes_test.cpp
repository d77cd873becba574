// Many modes at once: clusters, near-equal pairs, and the two solvers against each other and a dense one.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "mesher/tets/tetrahedralize.h"
#include "modal/solve/inverse_iteration.h"
#include "modal/solve/lanczos.h"
#include "tests/support/solids/block_tets.h"
#include "tests/support/solids/other_solvers.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

struct Held {
  System system;
  std::vector<uint8_t> held;  // per dof
};

/// A cantilever of square section: its bending modes come in near-equal pairs.
Held cantilever() {
  const NodeMesh nodes = make_nodes(
      make_block(4, 1, 1, [](const Vec3& p) { return Vec3(p.x(), 0.1 * p.y(), 0.1 * p.z()); }), Element::T10);
  Held one{assemble(nodes, Element::T10, {}), {}};
  for (const Vec3& p : nodes.positions) one.held.insert(one.held.end(), 3, p.x() == 0);
  return one;
}

/// Side by side, not joined: the i-th `1 + i step` times as stiff.
Held copies(const Held& one, int count, double step) {
  Held all{one.system, {}};
  all.system.start = {0}, all.system.row.clear(), all.system.stiffness.clear(), all.system.mass.clear();
  const auto nodes = static_cast<uint32_t>(one.system.nodes());
  for (int copy = 0; copy < count; ++copy) {
    for (uint32_t c = 0; c < nodes; ++c) {
      for (uint32_t e = one.system.start[c]; e < one.system.start[c + 1]; ++e) {
        all.system.row.push_back(static_cast<uint32_t>(copy) * nodes + one.system.row[e]);
        all.system.stiffness.push_back((1 + copy * step) * one.system.stiffness[e]);
        all.system.mass.push_back(one.system.mass[e]);
      }
      all.system.start.push_back(static_cast<uint32_t>(all.system.row.size()));
    }
    all.held.insert(all.held.end(), one.held.begin(), one.held.end());
  }
  return all;
}

Eigen::VectorXd dense_eigenvalues(const Held& problem) {
  const Matrices matrices = free_matrices(problem.system, problem.held);
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(matrices.K, matrices.M,
                                                                   Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double largest_deviation_from_orthonormal(const System& system, const NodalVectors& x) {
  const Eigen::MatrixXd gram = x.transpose() * system.multiply_mass(x);
  return (gram - Eigen::MatrixXd::Identity(x.cols(), x.cols())).cwiseAbs().maxCoeff();
}

// 1e-8: rounding of K's condition (1e7) on either side.
TEST(ManyModes, EveryVectorOfAMultipleEigenvalueIsFound) {
  const Held one = cantilever(), five = copies(one, 5, 0);
  const Eigen::VectorXd exact = dense_eigenvalues(one);
  const EigenResult found = lowest_eigenpairs(five.system, five.held, {.modes = 20});
  ASSERT_TRUE(found.converged) << found.residual;
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(found.eigenvalues[i] / exact[i / 5], 1, 1e-8) << "mode " << i + 1;
  EXPECT_LT(largest_deviation_from_orthonormal(five.system, found.vectors), 1e-8);
}

TEST(ManyModes, NearlyEqualModesAreToldApart) {
  constexpr double kStep = 1e-6;
  const Held one = cantilever(), three = copies(one, 3, kStep);
  const Eigen::VectorXd exact = dense_eigenvalues(three);
  const EigenResult found = lowest_eigenpairs(three.system, three.held, {.modes = 12});
  ASSERT_TRUE(found.converged) << found.residual;
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(found.eigenvalues[i] / exact[i], 1, 1e-8) << "mode " << i + 1;
  EXPECT_LT(largest_deviation_from_orthonormal(three.system, found.vectors), 1e-8);
}

TEST(ManyModes, LanczosAndInverseIterationAgree) {
  for (const double length : {0.1, 0.4, 1.6}) {
    const MarkedMesh prism = make_prism(6, length, 0.02);
    const NodeMesh nodes = make_nodes(tetrahedralize(prism.mesh, prism.is_root), Element::T10);
    Held rod{assemble(nodes, Element::T10, {}), {}};
    for (const uint8_t root : nodes.on_root) rod.held.insert(rod.held.end(), 3, root);
    FreeProblem problem(rod.system, rod.held, 0);
    const EigenResult few = inverse_iteration(problem, {.modes = 2, .tolerance = 1e-6});
    const EigenResult many = lanczos(problem, {.modes = 8});
    ASSERT_TRUE(few.converged && many.converged);
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(std::sqrt(few.eigenvalues[i] / many.eigenvalues[i]), 1, 1e-8) << length << " m";
    EXPECT_TRUE(few.sway_eigenvalues.isApprox(many.sway_eigenvalues, 1e-10));
  }
}

// Beyond half of the dof the mesh answers, not the solid.
TEST(ManyModes, NoMoreThanHalfOfTheDofAreGiven) {
  const Held one = cantilever();
  const EigenResult found = lowest_eigenpairs(one.system, one.held, {.modes = 1000});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.eigenvalues.size(), found.dof / 2);
  EXPECT_NEAR(found.eigenvalues[found.dof / 2 - 1] / dense_eigenvalues(one)[found.dof / 2 - 1], 1, 1e-8);
}

}  // namespace
}  // namespace liana
