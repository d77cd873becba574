#include "runtime/growth/segments.h"

#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/topology.h"

namespace liana {

ParticleId append_segment(Plant& plant, BranchId branch, const Attachment& at, const SegmentShape& shape,
                          const Quat& orientation) {
  Particle particle;
  particle.parent = at.parent;
  particle.half_length = shape.half_length;
  particle.half_width = shape.half_width;
  particle.half_thickness = shape.half_thickness;
  particle.joint.on_parent = at.on_parent;
  particle.joint.on_self = {0, -shape.half_length - shape.stalk, 0};

  Motion motion;
  motion.orientation = orientation;
  const Vec3 from_joint = orientation * -particle.joint.on_self;
  if (at.parent.valid()) {
    const Motion& parent = plant.motion[at.parent.index()];
    const Vec3 lever = parent.orientation * at.on_parent + from_joint;
    particle.joint.rest = parent.orientation.conjugate() * orientation;
    motion.position = parent.position + lever;
    motion.angular_velocity = parent.angular_velocity;
    motion.angular_acceleration = parent.angular_acceleration;
    motion.velocity = parent.velocity + parent.angular_velocity.cross(lever);
    motion.acceleration = parent.acceleration + parent.angular_acceleration.cross(lever);
  } else {
    particle.joint.rest = orientation;
    motion.position = at.on_parent + from_joint;
  }
  return append_particle(plant, branch, particle, motion);
}

Vec3 forward_of(const Plant& plant, ParticleId particle) {
  return plant.motion[particle.index()].orientation * Vec3::UnitY();
}

Vec3 head_of(const Plant& plant, ParticleId particle) {
  return plant.motion[particle.index()].position +
         forward_of(plant, particle) * plant.particles[particle.index()].half_length;
}

Vec3 joint_point_of(const Plant& plant, ParticleId particle) {
  const Motion& motion = plant.motion[particle.index()];
  return motion.position + motion.orientation * plant.particles[particle.index()].joint.on_self;
}

void turn_segment(Plant& plant, ParticleId particle, const Quat& world_rotation) {
  Particle& segment = plant.particles[particle.index()];
  Motion& motion = plant.motion[particle.index()];
  const Vec3 joint = joint_point_of(plant, particle);
  // With R = R_p R̄ D, D the deformation: R_g R = R_p (R_pᵀ R_g R_p R̄) D.
  const Quat parent =
      segment.parent.valid() ? plant.motion[segment.parent.index()].orientation : Quat::Identity();
  segment.joint.rest = (parent.conjugate() * world_rotation * parent * segment.joint.rest).normalized();
  motion.orientation = (world_rotation * motion.orientation).normalized();
  motion.position = joint - motion.orientation * segment.joint.on_self;
}

void keep_out(Plant& plant, ParticleId particle, const Vec3& point, double radius,
              const Surroundings& around) {
  const Motion& motion = plant.motion[particle.index()];
  const Vec3 x = motion.position + motion.orientation * point;
  const Vec3 way = way_out(x, radius, around);
  if (way.isZero(0)) return;
  const Vec3 joint = joint_point_of(plant, particle);
  turn_segment(plant, particle, Quat::FromTwoVectors(x - joint, x + way - joint));
}

void lengthen_segment(Plant& plant, ParticleId particle, double by) {
  Particle& segment = plant.particles[particle.index()];
  segment.half_length += by / 2;
  segment.joint.on_self.y() -= by / 2;
  plant.motion[particle.index()].position += forward_of(plant, particle) * (by / 2);
}

void set_mass(Particle& particle, DomainKind kind, double density) {
  const double a = particle.half_width, b = particle.half_length, c = particle.half_thickness;
  const double volume = kind == DomainKind::Leaf ? 0.5 * 8 * a * b * c : 2 * kPi * a * b * c;
  particle.mass = density * volume;
  particle.inertia = rod_inertia(particle.mass, b, a, c);
}

}  // namespace liana
