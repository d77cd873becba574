#include "runtime/sim/model/grab_spring.h"

namespace liana {

WorldSpring grab_spring(const Plant& plant, ParticleId particle, const Vec3& on_particle, const Vec3& gravity,
                        double time_step, double strength) {
  constexpr double kStretchUnderWeight = 0.02;  // m
  constexpr double kOnEarth = 9.81;             // m/s²
  double mass = 0;
  for (const Particle& each : plant.particles) mass += each.mass;
  const double weight = (gravity.isZero() ? kOnEarth : gravity.norm()) * mass;
  const Motion& motion = plant.motion[particle.index()];
  WorldSpring spring;
  spring.particle = particle;
  spring.on_particle = on_particle;
  spring.target = motion.position + motion.orientation * on_particle;
  spring.stiffness = strength * weight / kStretchUnderWeight * Mat3::Identity();
  spring.damping = 2 * time_step * spring.stiffness;
  return spring;
}

}  // namespace liana
