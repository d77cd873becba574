#include "runtime/sim/calibrate/calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "runtime/sim/calibrate/discrete_response.h"

namespace liana {
namespace {

UnitOscillator wanted_oscillator(const Branch& branch, const TimeScheme& scheme) {
  return discrete_oscillator(branch.material.frequency, branch.material.damping_factor, scheme.substep(),
                             scheme.rho_infinity);
}

std::vector<BranchId> out_of_range(const Plant& plant, const TimeScheme& scheme) {
  std::vector<BranchId> failing;
  for (size_t i = 0; i < plant.branches.size(); ++i)
    if (!wanted_oscillator(plant.branches[i], scheme).in_range) failing.push_back(BranchId(i));
  return failing;
}

// From the cheapest to the dearest: a larger ρ∞ costs nothing but some damping of the stiffest modes, a
// substep costs a step.
std::vector<TimeScheme> candidates(const TimeScheme& wanted) {
  std::vector<TimeScheme> list{wanted};
  for (int finer = 1; finer <= 16; finer *= 2)
    for (double rho : {0.6, 0.7, 0.8, 0.9})
      if (finer > 1 || rho > wanted.rho_infinity)
        list.push_back({wanted.dt, rho, wanted.substeps * finer, wanted.solver});
  return list;
}

}  // namespace

CalibrationReport calibrate_plant(Plant& plant, const TimeScheme& wanted) {
  CalibrationReport report;
  report.branches = plant.branches.size();
  report.beyond_wanted = report.out_of_range = out_of_range(plant, wanted);
  report.scheme = wanted;
  for (const TimeScheme& scheme : candidates(wanted)) {
    if (report.out_of_range.empty()) break;
    std::vector<BranchId> failing = out_of_range(plant, scheme);
    if (failing.size() >= report.out_of_range.size()) continue;
    report.out_of_range = std::move(failing);
    report.scheme = scheme;
  }
  if (!report.beyond_wanted.empty())
    report.note = fmt::format(
        "{} of {} branches are out of range at rho {:.2f} with {} substep(s) of {:.4g} ms: rho {:.2f}, {} "
        "substep(s) "
        "instead, which leaves {} out of range",
        report.beyond_wanted.size(), report.branches, wanted.rho_infinity, wanted.substeps,
        1e3 * wanted.substep(), report.scheme.rho_infinity, report.scheme.substeps,
        report.out_of_range.size());

  plant.scheme = report.scheme;
  const std::vector<double> carried = carried_masses(plant);
  HeldChain chain;
  for (size_t i = 0; i < plant.branches.size(); ++i) recalibrate(plant, BranchId(i), carried, chain);
  return report;
}

bool recalibrate(Plant& plant, BranchId id, std::span<const double> carried, HeldChain& chain, double most) {
  Branch& branch = plant.branches[id.index()];
  require(!branch.particles.empty(), "a branch has particles");
  const UnitOscillator target = wanted_oscillator(branch, plant.scheme);
  chain.build(plant, id, carried);
  const double scale =
      std::clamp(target.stiffness / chain.lowest_eigenvalue(), fixed::exp(-most), fixed::exp(most));
  branch.stiffness_scale *= scale;

  // The step adds its own damping, so c* is not 2ξω; it is shared out as the bake shares that.
  const DomainMaterial& baked = branch.material;
  const double by_mass = baked.mass_damping;
  const double by_stiffness = baked.stiffness_damping * fixed::pow(2 * kPi * baked.frequency, 2);
  const double share = by_mass + by_stiffness > 0 ? by_mass / (by_mass + by_stiffness) : 0.5;
  for (const ParticleId p : branch.particles) {
    Particle& particle = plant.particles[p.index()];
    const Joint& joint = particle.joint;
    set_stiffness(plant, p, scale * joint.shear_stiffness, scale * joint.bend_stiffness);
    particle.mass_damping = share * target.damping;
    particle.stiffness_damping = (1 - share) * target.damping / target.stiffness;
  }
  return target.in_range;
}

void set_stiffness(Plant& plant, ParticleId id, const Vec3& shear, const Vec3& bend) {
  const auto pose = [&](ParticleId p) {
    const Motion& m = plant.motion[p.index()];
    return BodyPose{.position = m.position, .orientation = m.orientation};
  };
  Particle& particle = plant.particles[id.index()];
  Joint& joint = particle.joint;
  const JointStrain e =
      joint_strain(joint, particle.parent.valid() ? pose(particle.parent) : BodyPose(), pose(id));
  joint.rest_force += (shear - joint.shear_stiffness).cwiseProduct(e.shear);
  joint.rest_moment += (bend - joint.bend_stiffness).cwiseProduct(e.bend.vector);
  joint.shear_stiffness = shear;
  joint.bend_stiffness = bend;
}

}  // namespace liana
