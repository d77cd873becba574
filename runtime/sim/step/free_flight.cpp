#include "runtime/sim/step/free_flight.h"

#include <algorithm>

namespace liana {

bool is_free(const Plant& plant) {
  return std::all_of(plant.particles.begin(), plant.particles.end(), [](const Particle& particle) {
    const Joint& joint = particle.joint;
    return particle.parent.valid() || (joint.shear_stiffness.isZero(0) && joint.bend_stiffness.isZero(0) &&
                                       joint.rest_force.isZero(0) && joint.rest_moment.isZero(0));
  });
}

void keep_angular_momentum(std::span<const Motion> before, Plant& plant) {
  if (plant.particles.empty() || !plant.particles[0].joint.shear_stiffness.isZero(0)) return;
  double mass = 0;
  for (const Particle& particle : plant.particles) {
    if (particle.mass_damping != 0) return;
    mass += particle.mass;
  }
  if (!is_free(plant) || !(mass > 0)) return;
  Vec3 centre = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  const auto angular_momentum = [&](std::span<const Motion> motion) {
    Vec3 drift = Vec3::Zero(), sum = Vec3::Zero();
    centre.setZero();
    inertia.setZero();
    for (size_t i = 0; i < motion.size(); ++i) {
      centre += plant.particles[i].mass / mass * motion[i].position;
      drift += plant.particles[i].mass / mass * motion[i].velocity;
    }
    for (size_t i = 0; i < motion.size(); ++i) {
      const Particle& particle = plant.particles[i];
      const Vec3 arm = motion[i].position - centre;
      const Mat3 R = motion[i].orientation.toRotationMatrix(),
                 J = R * particle.inertia.asDiagonal() * R.transpose();
      sum += particle.mass * arm.cross(motion[i].velocity - drift) + J * motion[i].angular_velocity;
      inertia += J + particle.mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
    }
    return sum;
  };
  const Vec3 wanted = angular_momentum(before), missing = wanted - angular_momentum(plant.motion);
  const Vec3 turn = inertia.ldlt().solve(missing);
  if (!turn.allFinite() || !((inertia * turn - missing).norm() <= 1e-6 * wanted.norm())) return;
  for (Motion& m : plant.motion) {
    m.velocity += turn.cross(m.position - centre);
    m.angular_velocity += turn;
  }
}

}  // namespace liana
