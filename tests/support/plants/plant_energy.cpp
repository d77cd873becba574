#include "tests/support/plants/plant_energy.h"

#include "runtime/sim/step/joints.h"

namespace liana {

double visible_energy(const Plant& plant) {
  double sum = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const auto pose = [&](size_t k) {
      return BodyPose{.position = plant.motion[k].position, .orientation = plant.motion[k].orientation};
    };
    const JointStrain e =
        joint_strain(p.joint, p.parent.valid() ? pose(p.parent.index()) : BodyPose(), pose(i));
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum += 0.5 * (p.mass * m.velocity.squaredNorm() + p.inertia.dot(spin.cwiseAbs2()) +
                  p.joint.bend_stiffness.dot(e.bend.vector.cwiseAbs2())) -
           p.joint.rest_moment.dot(e.bend.vector) + 9.81 * p.mass * m.position.y();
  }
  return sum;
}

}  // namespace liana
