#include "runtime/sim/check/frequency_probe.h"

#include "mesher/base/error.h"
#include "runtime/sim/step/time_step.h"

namespace liana {
namespace {

Vec3 tip_of(const Plant& plant) {
  const Motion& m = plant.motion.back();
  return m.position + m.orientation * Vec3(0, plant.particles.back().half_length, 0);
}

// Returns how far the tip went.
Vec3 bend(Plant& plant, std::span<const Vec6> mode, double distance) {
  const Vec6& last = mode.back();
  const Vec3 lever = tip_of(plant) - plant.motion.back().position;
  const double unit = (last.head<3>() + Vec3(last.tail<3>()).cross(lever)).norm();
  // A mode that only twists moves no tip: then the section's rim goes the distance.
  const double rim = last.tail<3>().norm() * plant.particles.back().half_width;
  const double scale = distance / std::max(unit, rim);
  const Vec3 before = tip_of(plant);
  for (size_t i = 0; i < plant.motion.size(); ++i) {
    Motion& m = plant.motion[i];
    m.position += scale * mode[i].head<3>();
    m.orientation = (rotation_exp(scale * mode[i].tail<3>()) * m.orientation).normalized();
  }
  return tip_of(plant) - before;
}

}  // namespace

ProbeResult probe(const HeldChain& chain, const ProbeOptions& options) {
  require(!chain.mode().empty(), "the chain's mode is known");
  Plant plant = chain.plant();
  // The same substeps, each seen: at 25 ms a motion of more than 20 Hz could not be told from a slower one.
  plant.scheme = {plant.scheme.substep(), plant.scheme.rho_infinity, 1, plant.scheme.solver};
  double length = 0;
  for (const Particle& particle : plant.particles) length += 2 * particle.half_length;
  const Vec3 rest = tip_of(plant);
  const Vec3 direction = bend(plant, chain.mode(), options.amplitude * length).normalized();
  PlantStepper stepper;
  const StepOptions step{.dt = plant.scheme.dt, .gravity = Vec3::Zero()};

  std::vector<double> record{direction.dot(tip_of(plant) - rest)};
  const double silence = 1e-7 * std::abs(record[0]);
  int sign_changes = 0, quiet = 0;
  while (static_cast<int>(record.size()) <= options.most_steps) {
    stepper.step(plant, {}, {}, step);
    record.push_back(direction.dot(tip_of(plant) - rest));
    const double now = record.back(), before = record[record.size() - 2];
    if ((now < 0) != (before < 0)) ++sign_changes;
    quiet = std::abs(now) < silence ? quiet + 1 : 0;
    if (static_cast<int>(record.size()) < options.least_steps) continue;
    if (sign_changes > 2 * options.swings || quiet > 20) break;
  }
  // The first two samples hold the start from rest, which is not part of a free decay.
  return {fit_damped_sinusoid(std::span(record).subspan(2), plant.scheme.dt),
          static_cast<int>(record.size()) - 1};
}

}  // namespace liana
