#include "runtime/sim/calibrate/equilibrium.h"

#include "runtime/sim/step/joints.h"

namespace liana {

void carry_weight(Plant& plant, const Vec3& gravity) {
  const auto pose = [&](size_t i) {
    return BodyPose{.position = plant.motion[i].position, .orientation = plant.motion[i].orientation};
  };
  // What hangs beyond each particle, itself included: its weight, and its moment about the particle's centre.
  std::vector<Vec3> force(plant.particles.size(), Vec3::Zero()), moment = force;
  for (size_t i = plant.particles.size(); i-- > 0;) {
    Particle& particle = plant.particles[i];
    Joint& joint = particle.joint;
    const bool root = !particle.parent.valid();
    const JointStrain e = joint_strain(joint, root ? BodyPose() : pose(particle.parent.index()), pose(i));
    force[i] += particle.mass * gravity;
    const Vec3 at_joint = moment[i] - e.from_child.cross(force[i]);
    joint.rest_force = joint.shear_stiffness.cwiseProduct(e.shear) - e.frame.transpose() * force[i];
    // The joint's moment acts through Hᵀ, H = rate Fᵀ (see joints.h).
    const Mat3 H = e.bend.rate() * e.frame.transpose();
    joint.rest_moment =
        joint.bend_stiffness.cwiseProduct(e.bend.vector) - H.transpose().partialPivLu().solve(at_joint);
    if (root) continue;
    const size_t p = particle.parent.index();
    force[p] += force[i];
    moment[p] += at_joint + e.from_parent.cross(force[i]);
  }
}

}  // namespace liana
