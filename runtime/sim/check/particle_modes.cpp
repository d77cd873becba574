#include "runtime/sim/check/particle_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

class Iteration {
 public:
  Iteration(const Plant& plant, Eigen::Index width)
      : plant_(plant), joint_(plant.particles.size()), X_(6 * plant.particles.size(), width) {
    const auto pose = [&](ParticleId id) {
      const Motion& m = plant.motion[id.index()];
      return BodyPose{.position = m.position, .orientation = m.orientation};
    };
    for (size_t i = 0; i < joint_.size(); ++i) {
      const Particle& particle = plant.particles[i];
      const BodyPose parent = particle.parent.valid() ? pose(particle.parent) : BodyPose();
      joint_[i] = joint_strain(particle.joint, parent, pose(ParticleId(i)));
    }
    uint64_t state = 0x9e3779b97f4a7c15;  // xorshift: the same start on every machine
    for (Eigen::Index c = 0; c < width; ++c)
      for (Eigen::Index r = 0; r < X_.rows(); ++r) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        X_(r, c) = static_cast<double>(state >> 11) * 0x1p-52 - 1;
      }
  }

  /// One step of inverse iteration with Rayleigh-Ritz; returns ω², ascending.
  Eigen::VectorXd step() {
    MX_ = multiply_mass(X_);
    const Eigen::MatrixXd KX = MX_;  // of K⁻¹ M X
    for (Eigen::Index c = 0; c < X_.cols(); ++c) apply_compliance(c);
    MX_ = multiply_mass(X_);
    const Eigen::VectorXd scale = X_.cwiseProduct(MX_).colwise().sum().cwiseSqrt().cwiseInverse();
    X_ = X_ * scale.asDiagonal();
    Eigen::MatrixXd H = X_.transpose() * KX * scale.asDiagonal(),
                    G = X_.transpose() * MX_ * scale.asDiagonal();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz((H + H.transpose()) / 2,
                                                                         (G + G.transpose()) / 2);
    X_ = X_ * ritz.eigenvectors();
    return ritz.eigenvalues();
  }

  const Eigen::MatrixXd& shapes() const { return X_; }

 private:
  Eigen::MatrixXd multiply_mass(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y(x.rows(), x.cols());
    for (size_t i = 0; i < joint_.size(); ++i) {
      const Quat& q = plant_.motion[i].orientation;
      for (Eigen::Index c = 0; c < x.cols(); ++c) {
        const Vec3 turn = q.conjugate() * Vec3(x.col(c).segment<3>(6 * i + 3));
        y.col(c).segment<3>(6 * i) = plant_.particles[i].mass * x.col(c).segment<3>(6 * i);
        y.col(c).segment<3>(6 * i + 3) = q * Vec3(plant_.particles[i].inertia.cwiseProduct(turn));
      }
    }
    return y;
  }

  /// X ← K⁻¹ (MX). Parents come before children.
  void apply_compliance(Eigen::Index column) {
    const size_t n = joint_.size();
    std::vector<Vec3> force(n), moment(n);  // of a particle and all beyond, about its centre
    auto load = MX_.col(column);
    auto x = X_.col(column);
    for (size_t i = 0; i < n; ++i) force[i] = load.segment<3>(6 * i), moment[i] = load.segment<3>(6 * i + 3);
    for (size_t i = n; i-- > 0;) {
      const JointStrain& joint = joint_[i];
      const Joint& own = plant_.particles[i].joint;
      const Vec3 at_joint = moment[i] - joint.from_child.cross(force[i]);
      x.segment<3>(6 * i) =
          joint.frame * (joint.frame.transpose() * force[i]).cwiseQuotient(own.shear_stiffness);
      x.segment<3>(6 * i + 3) =
          joint.frame * (joint.frame.transpose() * at_joint).cwiseQuotient(own.bend_stiffness);
      if (const ParticleId parent = plant_.particles[i].parent; parent.valid()) {
        force[parent.index()] += force[i];
        moment[parent.index()] += at_joint + joint.from_parent.cross(force[i]);
      }
    }
    for (size_t i = 0; i < n; ++i) {
      const JointStrain& joint = joint_[i];
      Vec3 move = Vec3::Zero(), turn = Vec3::Zero();
      if (const ParticleId parent = plant_.particles[i].parent; parent.valid()) {
        turn = x.segment<3>(6 * parent.index() + 3);
        move = x.segment<3>(6 * parent.index()) + turn.cross(joint.from_parent);
      }
      const Vec3 point = move + x.segment<3>(6 * i);
      turn += x.segment<3>(6 * i + 3);
      x.segment<3>(6 * i) = point - turn.cross(joint.from_child);
      x.segment<3>(6 * i + 3) = turn;
    }
  }

  const Plant& plant_;
  std::vector<JointStrain> joint_;
  Eigen::MatrixXd X_, MX_;
};

}  // namespace

ParticleModes particle_modes(const Plant& plant, int count) {
  require(!plant.particles.empty(), "a plant has particles");
  const auto rows = static_cast<Eigen::Index>(6 * plant.particles.size());
  const Eigen::Index wanted = std::min<Eigen::Index>(count, rows);
  // The slowest of the wanted modes converges with (ω_count / ω_width)² a step.
  const Eigen::Index width = std::min<Eigen::Index>(rows, 2 * wanted + 8);
  Iteration iteration(plant, width);
  ParticleModes modes;
  Eigen::VectorXd last = Eigen::VectorXd::Zero(width), values;
  for (modes.iterations = 1; modes.iterations <= 200; ++modes.iterations) {
    values = iteration.step();
    const double change =
        ((values - last).head(wanted).array() / values.head(wanted).array()).abs().maxCoeff();
    last = values;
    if (change < 1e-8) {
      modes.converged = true;
      break;
    }
  }
  for (Eigen::Index m = 0; m < wanted; ++m) {
    modes.frequencies.push_back(std::sqrt(values[m]) / (2 * kPi));
    std::vector<Vec6>& shape = modes.shapes.emplace_back();
    for (size_t i = 0; i < plant.particles.size(); ++i)
      shape.push_back(iteration.shapes().col(m).segment<6>(6 * i));
  }
  return modes;
}

double assurance(const Plant& plant, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const double m = plant.particles[i].mass;
    ab += m * a[i].dot(b[i]), aa += m * a[i].squaredNorm(), bb += m * b[i].squaredNorm();
  }
  return aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}

}  // namespace liana
