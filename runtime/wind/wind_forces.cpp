#include "runtime/wind/wind_forces.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/generalized_alpha.h"

namespace liana {

double projected_area(const Particle& particle, const Vec3& u) {
  const double a = particle.half_width, b = particle.half_length, c = particle.half_thickness;
  return kPi * Vec3(b * c * u.x(), a * c * u.y(), a * b * u.z()).norm();
}

void add_wind(const Plant& plant, const WindField& wind, double time, const DragOptions& options,
              std::vector<WorldSpring>& springs) {
  const double alpha_f = GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f;
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
    // The step takes forces at n+1-α_f: mixed with the present velocity by α_f, the drag is that of n+1.
    const double drag = options.air_density / 2 * coefficient * area * speed;
    dashpot.damping = Mat3::Identity() * (drag / (1 - alpha_f));
    dashpot.target_velocity = (1 - alpha_f) * air + alpha_f * motion.velocity;
    springs.push_back(dashpot);
  }
}

}  // namespace liana
