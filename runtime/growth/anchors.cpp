#include "runtime/growth/anchors.h"

#include <algorithm>

#include "mesher/base/error.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

constexpr double kGives = 3;  // times the force that a contact may push with: then the stem's joint holds yet

}  // namespace

bool Anchors::attach(Plant& plant, ParticleId particle, const Surroundings& around) {
  if (holds(particle)) return true;
  require(records_.size() == plant.anchors.size(), "all anchors of a climber are its own");
  const Particle& segment = plant.particles[particle.index()];
  const Motion& motion = plant.motion[particle.index()];
  const double reach = segment.half_width + parameters_.touch_gap;
  auto support = closest_support(around.obstacles, motion.position, reach);
  const double height = motion.position.y() - around.ground_height;
  if (!support && height <= reach)
    support = {motion.position - height * Vec3::UnitY(), Vec3::UnitY(), height};
  if (!support) return false;

  Record record;
  record.particle = particle;
  // Roots bridge the gap as it is: holding on does not pull.
  record.gap = support->distance - segment.half_width;
  record.solid = support->solid;
  record.on_solid = support->solid ? support->solid->to_mesh(support->point) : support->point;
  record.normal =
      support->solid ? support->solid->pose().rotation.conjugate() * support->normal : support->normal;
  WorldSpring spring;
  spring.particle = particle;
  spring.target = motion.position;
  records_.push_back(record);
  plant.anchors.push_back(spring);
  held_.resize(std::max(held_.size(), plant.particles.size()));
  Held& held = held_[particle.index()];
  held.now = true;
  records_.back().lineage = child_lineage(plant.lineage_of(particle), LineageKind::Anchor, held.times++);
  return true;
}

void Anchors::update(Plant& plant, double dt_growth) {
  require(records_.size() == plant.anchors.size(), "all anchors of a climber are its own");
  size_t kept = 0;
  for (size_t i = 0; i < records_.size(); ++i) {
    Record& record = records_[i];
    WorldSpring& spring = plant.anchors[i];
    const Particle& segment = plant.particles[spring.particle.index()];
    const Motion& motion = plant.motion[spring.particle.index()];
    record.age += dt_growth;
    const double hard = std::min(1.0, record.age / parameters_.seconds_to_full);
    const double stiffness = parameters_.stiffness * hard * segment.half_width / young_radius_;
    spring.stiffness = stiffness * Mat3::Identity();
    spring.damping = parameters_.damping_time * spring.stiffness;
    // Where the axis is held: at the skin, which turns with the stem, a taut anchor would make it spin.
    const double off = segment.half_width + record.gap;
    spring.target = record.on_solid + off * record.normal;
    Vec3 held = spring.target;  // now; the spring acts between now and the step's end
    if (record.solid) {
      const Vec3 at_end = record.solid->to_world(record.on_solid + off * record.normal);
      spring.target_velocity = record.solid->velocity_at(at_end);
      held = at_end - plant.scheme.dt * spring.target_velocity;
      spring.target = at_end - GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f * (at_end - held);
    }
    const double bearable = kGives * bearable_force(segment) / stiffness;
    if ((motion.position - held).norm() > std::min(parameters_.release_distance, bearable)) {
      held_[spring.particle.index()].now = false;
      ++released_;
      continue;
    }
    if (kept < i) records_[kept] = record, plant.anchors[kept] = spring;
    ++kept;
  }
  records_.resize(kept);
  plant.anchors.resize(kept);
}

void Anchors::follow(const Remap& remap) {
  remap.keep_particles(held_);
  std::erase_if(records_, [&](Record& record) {
    record.particle = remap(record.particle);
    return !record.particle.valid();
  });
}

}  // namespace liana
