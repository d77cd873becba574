#include "runtime/sim/model/breaking.h"

#include <algorithm>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

JointStrain strain_of(const Plant& plant, ParticleId id) {
  const auto pose = [&](ParticleId p) {
    const Motion& m = plant.motion[p.index()];
    return BodyPose{.position = m.position, .orientation = m.orientation};
  };
  const Particle& particle = plant.particles[id.index()];
  return joint_strain(particle.joint, particle.parent.valid() ? pose(particle.parent) : BodyPose(), pose(id));
}

// Half width and thickness at a joint: within a branch the mean of the two particles that it joins.
std::pair<double, double> section_of(const Plant& plant, const Particle& particle) {
  const double a = particle.half_width, b = particle.half_thickness;
  if (!particle.parent.valid()) return {a, b};
  const Particle& parent = plant.particles[particle.parent.index()];
  if (parent.branch != particle.branch) return {a, b};
  return {(a + parent.half_width) / 2, (b + parent.half_thickness) / 2};
}

// ½ Σ w²/C over the directions that have a stiffness.
double energy_of(const Vec3& load, const Vec3& stiffness) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (stiffness[k] > 0) sum += load[k] * load[k] / stiffness[k];
  return sum / 2;
}

}  // namespace

double joint_stress(const Plant& plant, ParticleId id) {
  const Particle& particle = plant.particles[id.index()];
  const Joint& joint = particle.joint;
  if (joint.shear_stiffness.isZero(0) && joint.bend_stiffness.isZero(0)) return 0;
  const auto [a, b] = section_of(plant, particle);
  if (!(a > 0 && b > 0)) return 0;
  const JointStrain e = strain_of(plant, id);
  const Vec3 moment = joint.bend_stiffness.cwiseProduct(e.bend.vector);
  const double axial = joint.shear_stiffness.y() * e.shear.y(), area = kPi * a * b;
  // c/I of an ellipse is 4/(area × the half axis that it bends over); the largest of a linear stress on it
  // is the root of the squares.
  const double about_x = 4 * moment.x() / (area * b), about_z = 4 * moment.z() / (area * a);
  return fixed::hypot(about_x, about_z) + std::abs(axial) / area;
}

double joint_energy(const Plant& plant, ParticleId id) {
  const Joint& joint = plant.particles[id.index()].joint;
  const JointStrain e = strain_of(plant, id);
  return energy_of(joint.shear_stiffness.cwiseProduct(e.shear) - joint.rest_force, joint.shear_stiffness) +
         energy_of(joint.bend_stiffness.cwiseProduct(e.bend.vector) - joint.rest_moment,
                   joint.bend_stiffness);
}

size_t set_strengths(Plant& plant, const SpeciesLaw& law, double sensitivity) {
  size_t unknown = 0;
  for (Branch& branch : plant.branches) {
    const double bears = modulus_of_rupture(law, branch.group);
    branch.strength = sensitivity > 0 ? bears / sensitivity : 0;
    unknown += bears == 0;
  }
  return unknown;
}

void find_fractures(const Plant& plant, size_t most, std::vector<Fracture>& found) {
  found.clear();
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const double strength = plant.branches[plant.particles[i].branch.index()].strength;
    if (!(strength > 0)) continue;
    const double stress = joint_stress(plant, ParticleId(i));
    if (stress > strength) found.push_back({ParticleId(i), stress});
  }
  if (found.empty()) return;
  const auto overload = [&](const Fracture& f) {
    return f.stress / plant.branches[plant.particles[f.at.index()].branch.index()].strength;
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const Fracture& x, const Fracture& y) { return overload(x) > overload(y); });
  enum : uint8_t { kWhole, kBreaks, kBearsABreak };
  std::vector<uint8_t> fate(plant.particles.size(), kWhole);
  std::erase_if(found, [&, kept = size_t{0}](const Fracture& f) mutable {
    if (kept == most || fate[f.at.index()] == kBearsABreak) return true;
    for (ParticleId p = f.at; p.valid(); p = plant.particles[p.index()].parent)
      if (fate[p.index()] == kBreaks) return true;
    for (ParticleId p = f.at; p.valid(); p = plant.particles[p.index()].parent)
      fate[p.index()] = kBearsABreak;
    fate[f.at.index()] = kBreaks;
    ++kept;
    return false;
  });
}

}  // namespace liana
