#include "runtime/sim/calibrate/held_chain.h"

#include <Eigen/Eigenvalues>

#include "mesher/base/error.h"

namespace liana {

std::vector<double> carried_masses(const Plant& plant) {
  const size_t n = plant.particles.size();
  std::vector<double> carried(n, 0), hanging(n, 0);
  for (size_t i = n; i-- > 0;) {
    const Particle& particle = plant.particles[i];
    if (!particle.parent.valid()) continue;
    const size_t p = particle.parent.index();
    const double mass = particle.mass + hanging[i];
    hanging[p] += mass;
    if (plant.particles[p].branch != particle.branch) carried[p] += mass;
  }
  return carried;
}

void HeldChain::build(const Plant& plant, BranchId id, std::span<const double> carried) {
  scheme_ = plant.scheme;
  branch_ = plant.branches[id.index()];
  const size_t n = branch_.particles.size();
  particles_.resize(n);
  rest_.resize(n);
  joint_.resize(n);
  BodyPose parent;
  for (size_t i = 0; i < n; ++i) {
    const ParticleId source = branch_.particles[i];
    Particle& particle = particles_[i] = plant.particles[source.index()];
    require(i == 0 || particle.parent == branch_.particles[i - 1], "a branch is a chain");
    particle.parent = i == 0 ? ParticleId() : ParticleId(i - 1);
    particle.branch = BranchId(0);
    particle.mass += carried[source.index()];
    particle.joint.rest_force = particle.joint.rest_moment = Vec3::Zero();
    BodyPose& pose = rest_[i];
    const Joint& joint = particle.joint;
    pose.orientation = (parent.orientation * joint.rest).normalized();
    pose.position = parent.position + parent.orientation * joint.on_parent - pose.orientation * joint.on_self;
    joint_[i] = joint_strain(joint, parent, pose);
    parent = pose;
  }
}

// A static guess that no mode is orthogonal to: bent to either side, with a little twist.
void HeldChain::start_vectors() {
  const double n = static_cast<double>(particles_.size());
  for (size_t i = 0; i < particles_.size(); ++i) {
    const double s = (static_cast<double>(i) + 1) / n;
    const Mat3 R = rest_[i].orientation.toRotationMatrix();
    const double length = 2 * particles_[i].half_length * n;
    const Vec3 twist = (0.1 * s) * R.col(1);
    X_.col(0).segment<6>(6 * i) << length * s * s * R.col(2), twist;
    X_.col(1).segment<6>(6 * i) << length * s * s * R.col(0), -twist;
  }
}

void HeldChain::apply_mass(int column) {
  for (size_t i = 0; i < particles_.size(); ++i) {
    const Quat& q = rest_[i].orientation;
    const auto x = X_.col(column).segment<6>(6 * i);
    const Vec3 turn = q.conjugate() * Vec3(x.tail<3>());
    MX_.col(column).segment<6>(6 * i) << particles_[i].mass * x.head<3>(),
        q * Vec3(particles_[i].inertia.cwiseProduct(turn));
  }
}

// X ← K⁻¹ (MX)
void HeldChain::apply_compliance(int column) {
  const size_t n = particles_.size();
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // of all beyond, about the current particle's centre
  auto strain = X_.col(column);
  for (size_t i = n; i-- > 0;) {
    force += MX_.col(column).segment<3>(6 * i);
    moment += MX_.col(column).segment<3>(6 * i + 3);
    const JointStrain& joint = joint_[i];
    const Vec3 at_joint = moment - joint.from_child.cross(force);
    const Joint& own = particles_[i].joint;
    strain.segment<3>(6 * i) =
        joint.frame * (joint.frame.transpose() * force).cwiseQuotient(own.shear_stiffness);
    strain.segment<3>(6 * i + 3) =
        joint.frame * (joint.frame.transpose() * at_joint).cwiseQuotient(own.bend_stiffness);
    moment = at_joint + joint.from_parent.cross(force);
  }
  Vec3 move = Vec3::Zero(), turn = Vec3::Zero();
  for (size_t i = 0; i < n; ++i) {
    const JointStrain& joint = joint_[i];
    const Vec3 point = move + turn.cross(joint.from_parent) + strain.segment<3>(6 * i);
    turn += strain.segment<3>(6 * i + 3);
    move = point - turn.cross(joint.from_child);
    strain.segment<6>(6 * i) << move, turn;
  }
}

double HeldChain::lowest_eigenvalue() {
  const auto rows = static_cast<Eigen::Index>(6 * particles_.size());
  if (X_.rows() != rows) {
    X_.resize(rows, 2);
    MX_.resize(rows, 2);
  }
  start_vectors();

  // Converged to 1e-10 in ω², far below the 1e-3 that a frequency is verified to. The third mode is well
  // above the first two (39 times, for a uniform rod), so a few turns do; 60 is for chains that are nothing
  // like rods.
  double value = 0, last = -1;
  for (iterations_ = 0; iterations_ < 60 && std::abs(value - last) > 1e-10 * value; ++iterations_) {
    last = value;
    apply_mass(0), apply_mass(1);
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& KX = MX_;  // K (K⁻¹ M X) = M X
    apply_compliance(0), apply_compliance(1);
    const Eigen::Matrix2d H = X_.transpose() * KX;
    apply_mass(0), apply_mass(1);
    const Eigen::Matrix2d G = X_.transpose() * MX_;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> ritz(H, G);
    value = ritz.eigenvalues()[0];
    for (Eigen::Index r = 0; r < rows; ++r) X_.row(r) = (X_.row(r) * ritz.eigenvectors()).eval();
  }
  mode_.resize(particles_.size());
  for (size_t i = 0; i < mode_.size(); ++i) mode_[i] = X_.col(0).segment<6>(6 * i);
  return value;
}

Plant HeldChain::plant() const {
  Plant plant;
  plant.scheme = scheme_;
  plant.particles = particles_;
  plant.branches = {branch_};
  plant.branches[0].parent = BranchId();
  plant.branches[0].particles.clear();
  for (size_t i = 0; i < particles_.size(); ++i) {
    plant.branches[0].particles.push_back(ParticleId(i));
    plant.motion.push_back({.position = rest_[i].position, .orientation = rest_[i].orientation});
  }
  return plant;
}

}  // namespace liana
