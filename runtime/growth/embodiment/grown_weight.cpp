#include "runtime/growth/embodiment/grown_weight.h"

namespace liana {

void carry_grown_weight(Plant& plant, const Vec3& gravity, std::vector<RestPose>& rest) {
  const RestPose world;
  rest.resize(plant.particles.size());
  for (size_t i = 0; i < rest.size(); ++i) {  // root to leaves
    const Particle& particle = plant.particles[i];
    const RestPose& from = particle.parent.valid() ? rest[particle.parent.index()] : world;
    rest[i].orientation = from.orientation * particle.joint.rest;
    rest[i].force = rest[i].moment = Vec3::Zero();
  }
  for (size_t i = rest.size(); i-- > 0;) {
    Particle& particle = plant.particles[i];
    Vec3 &force = rest[i].force, &moment = rest[i].moment;
    force += particle.mass * gravity;
    const Quat to_joint = rest[i].orientation.conjugate();
    const Vec3 at_joint = moment - (rest[i].orientation * particle.joint.on_self).cross(force);
    particle.joint.rest_force = to_joint * -force;
    particle.joint.rest_moment = to_joint * -at_joint;
    if (!particle.parent.valid()) continue;
    RestPose& parent = rest[particle.parent.index()];
    parent.force += force;
    parent.moment += at_joint + (parent.orientation * particle.joint.on_parent).cross(force);
  }
}

void uncarried_weight(const Plant& plant, const Vec3& gravity, std::vector<JointLoad>& loads) {
  loads.assign(plant.particles.size(), {Vec3::Zero(), Vec3::Zero()});
  for (size_t i = loads.size(); i-- > 0;) {
    const Particle& particle = plant.particles[i];
    const Motion& motion = plant.motion[i];
    auto& [force, moment] = loads[i];  // the weight beyond, and its moment about the origin
    force += particle.mass * gravity;
    moment += motion.position.cross(particle.mass * gravity);
    Quat frame = particle.joint.rest;
    if (particle.parent.valid()) {
      frame = plant.motion[particle.parent.index()].orientation * frame;
      loads[particle.parent.index()].force += force;
      loads[particle.parent.index()].moment += moment;
    }
    const Vec3 joint = motion.position + motion.orientation * particle.joint.on_self;
    const Vec3 at_joint = moment - joint.cross(force);
    force = frame.conjugate() * -force - particle.joint.rest_force;
    moment = frame.conjugate() * -at_joint - particle.joint.rest_moment;
  }
}

}  // namespace liana
