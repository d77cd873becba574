#include <gtest/gtest.h>

#include <random>

#include "runtime/sim/model/rotation.h"
#include "tests/support/plants/tree_solver.h"

namespace liana {
namespace {

using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using DenseVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

Mat6 shift_matrix(const Vec3& lever) {  // T(r)
  Mat6 T = Mat6::Identity();
  T.topRightCorner<3, 3>() = -skew(lever);
  return T;
}

// A random tree: nodes of unit mass and size, a spring to the world on some; joints whose shear is `ratio`
// times their bending.
struct RandomTree {
  std::vector<uint32_t> parent;
  std::vector<TreeJoint> joints;
  std::vector<Mat3> inertia, spring;
  std::vector<Vec3> lever, force, torque;

  RandomTree(int nodes, double ratio, double bend, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto vector = [&] { return Vec3(u(random), u(random), u(random)); };
    const auto definite = [&](double scale) -> Mat3 {
      Mat3 m;
      m << vector(), vector(), vector();
      return scale * (m * m.transpose() + 0.1 * Mat3::Identity());
    };
    for (int i = 0; i < nodes; ++i) {
      const int span = std::min(i, 4);  // among the last few, so that the tree is deep and branches
      parent.push_back(i == 0 ? TreeSolver::kRoot
                              : i - 1 - std::uniform_int_distribution<int>(0, span - 1)(random));
      joints.push_back({vector(), vector(), definite(ratio * bend), definite(bend)});
      inertia.push_back(definite(0.1));
      spring.push_back(i % 5 == 3 ? definite(10) : Mat3::Zero());
      lever.push_back(vector());
      force.push_back(vector());
      torque.push_back(vector());
    }
  }

  // With the joints' wrenches λ as unknowns of their own, [A Gᵀ; G −W⁻¹] [a; λ] = [b; 0] stays well
  // conditioned as W grows, which the assembled matrix A + Gᵀ W G does not.
  DenseVector solve_dense() const {
    const auto n = static_cast<Eigen::Index>(parent.size());
    Dense K = Dense::Zero(12 * n, 12 * n);
    DenseVector b = DenseVector::Zero(12 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      Mat6 A = Mat6::Identity(), S = Mat6::Zero();
      A.bottomRightCorner<3, 3>() = inertia[i];
      S.topLeftCorner<3, 3>() = spring[i];
      A += shift_matrix(lever[i]).transpose() * S * shift_matrix(lever[i]);
      b.segment<3>(6 * i) = force[i].cast<long double>();
      b.segment<3>(6 * i + 3) = torque[i].cast<long double>();
      const Eigen::Index row = 6 * (n + i);
      K.block<6, 6>(6 * i, 6 * i) = A.cast<long double>();
      K.block<6, 6>(row, 6 * i) = shift_matrix(joints[i].from_self).cast<long double>();
      if (i > 0) K.block<6, 6>(row, 6 * parent[i]) = -shift_matrix(joints[i].from_parent).cast<long double>();
      K.block<3, 3>(row, row) = -Dense(joints[i].shear.cast<long double>()).inverse();
      K.block<3, 3>(row + 3, row + 3) = -Dense(joints[i].bend.cast<long double>()).inverse();
    }
    K.topRightCorner(6 * n, 6 * n) = K.bottomLeftCorner(6 * n, 6 * n).transpose().eval();
    return K.partialPivLu().solve(b).head(6 * n);
  }

  Eigen::VectorXd solve_tree() const {
    TreeSolver solver;
    solver.resize(parent.size());
    for (size_t i = 0; i < parent.size(); ++i) {
      solver.reset(i, 1, inertia[i], force[i], torque[i]);
      solver.add_point(i, lever[i], spring[i]);
    }
    for (size_t i = parent.size(); i-- > 0;) solver.eliminate(i, parent[i], joints[i]);
    Eigen::VectorXd a(static_cast<Eigen::Index>(6 * parent.size()));
    for (size_t i = 0; i < parent.size(); ++i) a.segment<6>(6 * i) = solver.substitute(i);
    return a;
  }

  double relative_error() const {
    const DenseVector exact = solve_dense();
    return static_cast<double>((solve_tree().cast<long double>() - exact).norm() / exact.norm());
  }
};

TEST(TreeSolver, MatchesDenseFactorisationOnRandomTrees) {
  // Well conditioned (below 1e4 or so): 1e-16 × condition leaves 1e-12.
  for (uint32_t seed = 0; seed < 20; ++seed)
    EXPECT_LT(RandomTree(1 + static_cast<int>(seed), 1, 1, seed).relative_error(), 1e-11) << "seed " << seed;
}

TEST(TreeSolver, KeepsItsDigitsWhenJointsAreMuchStifferThanWhatHangsOnThem) {
  // Joints up to 1e12 times the nodes' own blocks. The answer is that of a nearly rigid tree, itself well
  // conditioned: no more than a few digits may go, whatever the ratio. (The Schur form K − K(A+K)⁻¹K loses 12
  // of 16 here.)
  for (double ratio : {1e2, 1e4, 1e6})
    for (double bend : {1.0, 1e3, 1e6})
      for (uint32_t seed = 0; seed < 5; ++seed)
        EXPECT_LT(RandomTree(16, ratio, bend, seed).relative_error(), 1e-9)
            << "ratio " << ratio << ", bend " << bend << ", seed " << seed;
}

TEST(TreeSolver, JointWithoutStiffnessLetsGo) {
  // A node whose joint resists nothing moves as if alone: a = A⁻¹ b.
  TreeSolver solver;
  solver.resize(2);
  for (size_t i = 0; i < 2; ++i) solver.reset(i, 2, Mat3::Identity(), Vec3(1, 2, 3), Vec3(4, 5, 6));
  for (size_t i = 2; i-- > 0;)
    solver.eliminate(i, i == 0 ? TreeSolver::kRoot : 0,
                     {Vec3(0, 1, 0), Vec3(1, 0, 0), Mat3::Zero(), Mat3::Zero()});
  for (size_t i = 0; i < 2; ++i) {
    const Vec6 a = solver.substitute(i);
    EXPECT_NEAR((a - (Vec6() << 0.5, 1, 1.5, 4, 5, 6).finished()).norm(), 0, 1e-14);
  }
}

}  // namespace
}  // namespace liana
