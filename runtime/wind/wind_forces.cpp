#include "runtime/wind/wind_forces.h"

#include <algorithm>
#include <cmath>

namespace liana {

double projected_area(const Particle& particle, const Vec3& u) {
  const double a = particle.half_width, b = particle.half_length, c = particle.half_thickness;
  return kPi * Vec3(b * c * u.x(), a * c * u.y(), a * b * u.z()).norm();
}

void add_wind(const Plant& plant, const WindField& wind, double time, const DragOptions& options,
              std::vector<WorldSpring>& springs) {
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Motion& motion = plant.motion[i];
    const Vec3 air = wind.velocity(motion.position, time);
    const Vec3 relative = air - motion.velocity;
    double speed = relative.norm();
    if (speed == 0) continue;
    const double area = projected_area(particle, motion.orientation.conjugate() * (relative / speed));
    const bool leaf = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
    if (leaf) speed = std::min(speed, options.leaf_yield_speed);
    const double coefficient = leaf ? options.leaf_coefficient : options.stem_coefficient;

    WorldSpring dashpot;
    dashpot.particle = ParticleId(i);
    dashpot.target = motion.position;
    dashpot.damping = Mat3::Identity() * (options.air_density / 2 * coefficient * area * speed);
    dashpot.target_velocity = air;
    springs.push_back(dashpot);
  }
}

}  // namespace liana
