#include "runtime/sim/step/joint_projection.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

double kinetic_energy(const Plant& plant, std::span<const Motion> motion) {
  double sum = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Motion& m = motion[i];
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum += particle.mass * m.velocity.squaredNorm() + particle.inertia.dot(spin.cwiseAbs2());
  }
  return sum / 2;
}

}  // namespace

int project_joints(Plant& plant, std::span<const Motion> start, double gap_limit) {
  const double before = kinetic_energy(plant, start);
  int closed = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Joint& joint = particle.joint;
    Motion& m = plant.motion[i];
    m.acceleration = m.angular_acceleration = Vec3::Zero();
    if (joint.shear_stiffness.isZero(0)) continue;
    Vec3 place = joint.on_parent, velocity = Vec3::Zero();
    if (particle.parent.valid()) {
      const Motion& parent = plant.motion[particle.parent.index()];
      const Vec3 lever = parent.orientation * joint.on_parent;
      place = parent.position + lever;
      velocity = parent.velocity + parent.angular_velocity.cross(lever);
    }
    const Vec3 lever = m.orientation * joint.on_self;
    const Vec3 open = place - m.position - lever;
    if (!(open.norm() > gap_limit * gap_scale(particle))) continue;
    ++closed;
    m.position += open;
    m.velocity = velocity - m.angular_velocity.cross(lever);
  }
  const double after = kinetic_energy(plant, plant.motion);
  if (after > before) {
    const double slower = std::sqrt(before / after);
    for (Motion& m : plant.motion) m.velocity *= slower, m.angular_velocity *= slower;
  }
  return closed;
}

}  // namespace liana
