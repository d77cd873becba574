#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/calibrate/held_chain.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

double lowest(const Plant& plant) {
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  return chain.lowest_eigenvalue();
}

TEST(HeldChain, ConvergesToTheEulerBernoulliCantileverWithMoreParticles) {
  const test::RodShape rod;  // l/d = 50: shear and rotary inertia take less than 1e-3 of ω²
  const double area = kPi * rod.radius * rod.radius, I = kPi / 4 * std::pow(rod.radius, 4);
  const double exact =
      std::pow(3.51602, 2) * rod.youngs_modulus * I / (rod.density * area * std::pow(rod.length, 4));
  double last = 1;
  for (int n : {5, 10, 20, 40}) {
    const double error = std::abs(lowest(test::rod_plant(rod, n)) / exact - 1);
    // Second order in the segment's length, with a constant near 1 as midpoint rules have, on top of the 1e-3
    // of the rod's own slenderness, which no refinement removes.
    EXPECT_LT(error, 1.0 / (n * n) + 1e-3) << n << " particles";
    EXPECT_LT(error, last);
    last = error;
  }
}

TEST(HeldChain, LowestEigenvalueIsThatOfTheDenseMatrices) {
  const Plant plant = make_plant(test::synthetic_bake());
  const std::vector<double> carried = carried_masses(plant);
  HeldChain chain;
  for (size_t b = 0; b < plant.branches.size(); b += 5) {
    chain.build(plant, BranchId(b), carried);
    const double value = chain.lowest_eigenvalue();
    const Plant alone = chain.plant();
    const auto n = static_cast<Eigen::Index>(alone.particles.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(6 * n, 6 * n), M = K;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Particle& particle = alone.particles[i];
      const auto pose = [&](Eigen::Index k) {
        return k < 0 ? BodyPose()
                     : BodyPose{.position = alone.motion[k].position,
                                .orientation = alone.motion[k].orientation};
      };
      const JointStrain e = joint_strain(particle.joint, pose(i - 1), pose(i));
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, 6 * n);
      const Mat3 Ft = e.frame.transpose();
      J.block<3, 3>(0, 6 * i) = Ft;
      J.block<3, 3>(0, 6 * i + 3) = -Ft * skew(e.from_child);
      J.block<3, 3>(3, 6 * i + 3) = Ft;
      if (i > 0) {
        J.block<3, 3>(0, 6 * i - 6) = -Ft;
        J.block<3, 3>(0, 6 * i - 3) = Ft * skew(e.from_parent);
        J.block<3, 3>(3, 6 * i - 3) = -Ft;
      }
      Vec6 C;
      C << particle.joint.shear_stiffness, particle.joint.bend_stiffness;
      K += J.transpose() * C.asDiagonal() * J;
      const Mat3 R = pose(i).orientation.toRotationMatrix();
      M.block<3, 3>(6 * i, 6 * i) = particle.mass * Mat3::Identity();
      M.block<3, 3>(6 * i + 3, 6 * i + 3) = R * particle.inertia.asDiagonal() * R.transpose();
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M, Eigen::EigenvaluesOnly);
    // The dense solver resolves its smallest eigenvalue to 1e-16 of its largest, some 1e8 times larger.
    EXPECT_NEAR(value, dense.eigenvalues()[0], 1e-5 * value) << "branch " << b;
    EXPECT_LT(chain.iterations(), 30) << "branch " << b;
  }
}

TEST(HeldChain, CarriesTheMassOfAllThatGrowsFromIt) {
  const Bake bake = test::synthetic_bake();
  const Plant plant = make_plant(bake);
  const std::vector<double> carried = carried_masses(plant);
  double on_trunk = 0, others = 0;
  for (const ParticleId p : plant.branches[0].particles) on_trunk += carried[p.index()];
  for (size_t i = 1; i < bake.domains.size(); ++i) others += bake.domains[i].mass;
  EXPECT_NEAR(on_trunk, others, 1e-12 * others);
}

}  // namespace
}  // namespace liana
