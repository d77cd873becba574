#include "runtime/wind/field/wind_forces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/step/generalized_alpha.h"

namespace liana {

double projected_area(const Particle& particle, const Vec3& u) {
  const double a = particle.half_width, b = particle.half_length, c = particle.half_thickness;
  return kPi * Vec3(b * c * u.x(), a * c * u.y(), a * b * u.z()).norm();
}

double drag_factor(const Plant& plant, ParticleId id, const Vec3& relative, const DragOptions& options) {
  double speed = relative.norm();
  if (speed == 0) return 0;
  const Particle& particle = plant.particles[id.index()];
  const Quat& orientation = plant.motion[id.index()].orientation;
  const double area = projected_area(particle, orientation.conjugate() * (relative / speed));
  const bool leaf = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
  if (leaf && speed > options.leaf_yield_speed)
    speed *= fixed::pow(speed / options.leaf_yield_speed, options.leaf_vogel_exponent);
  return options.air_density / 2 * (leaf ? options.leaf_coefficient : options.stem_coefficient) * area *
         speed;
}

WorldSpring drag_dashpot(const Plant& plant, ParticleId particle, double factor, const Vec3& air) {
  const double alpha_f = GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f;
  const Motion& motion = plant.motion[particle.index()];
  WorldSpring dashpot;
  dashpot.particle = particle;
  dashpot.target = motion.position;
  // The step takes forces at n+1-α_f: mixed with the present velocity by α_f, the drag is that of n+1.
  dashpot.damping = Mat3::Identity() * (factor / (1 - alpha_f));
  dashpot.target_velocity = (1 - alpha_f) * air + alpha_f * motion.velocity;
  return dashpot;
}

void add_wind(const Plant& plant, const WindField& wind, double time, const DragOptions& options,
              std::vector<WorldSpring>& springs) {
  constexpr size_t kAtOnce = 64;
  std::array<Vec3, kAtOnce> places, air;
  for (size_t first = 0; first < plant.particles.size(); first += kAtOnce) {
    const size_t count = std::min(kAtOnce, plant.particles.size() - first);
    for (size_t i = 0; i < count; ++i) places[i] = plant.motion[first + i].position;
    wind.velocities({places.data(), count}, time, {air.data(), count});
    for (size_t i = 0; i < count; ++i) {
      const ParticleId id(first + i);
      const double factor = drag_factor(plant, id, air[i] - plant.motion[first + i].velocity, options);
      if (factor > 0) springs.push_back(drag_dashpot(plant, id, factor, air[i]));
    }
  }
}

}  // namespace liana
