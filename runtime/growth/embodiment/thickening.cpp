#include "runtime/growth/embodiment/thickening.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/growth/segments.h"
#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/model/rod_section.h"

namespace liana {

std::vector<double> pipe_radii(const Plant& plant, const std::vector<double>& young_radius, double exponent,
                               double leaf_radius) {
  std::vector<double> carried(plant.particles.size(), 0), radius(plant.particles.size(), 0);
  const double leaf = fixed::pow(leaf_radius, exponent);
  for (size_t i = plant.particles.size(); i-- > 0;) {
    const Particle& particle = plant.particles[i];
    const bool is_leaf = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
    if (!is_leaf) {
      carried[i] = std::max(carried[i], fixed::pow(young_radius[i], exponent));
      radius[i] = fixed::pow(carried[i], 1 / exponent);
    }
    if (particle.parent.valid()) carried[particle.parent.index()] += is_leaf ? leaf : carried[i];
  }
  return radius;
}

void thicken(Plant& plant, const std::vector<double>& young_radius, const std::vector<double>& joint_length,
             const ThickeningParameters& parameters, const ElasticMaterial& material, double dt) {
  const std::vector<double> wanted =
      pipe_radii(plant, young_radius, parameters.exponent, parameters.leaf_radius);
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    Particle& particle = plant.particles[i];
    const double radius = std::min(wanted[i], particle.half_width * (1 + parameters.largest_rate * dt));
    if (!(radius > particle.half_width)) continue;  // leaves too: they want 0
    const Branch& branch = plant.branches[particle.branch.index()];
    particle.half_width = particle.half_thickness = radius;
    set_mass(particle, DomainKind::Branch, material.density * branch.material.mass_scaling);
    const RodSection section =
        rod_section(material.youngs_modulus, material.poisson_ratio, radius, radius, 1);
    const double scale = branch.stiffness_scale / joint_length[i];
    set_stiffness(plant, ParticleId(i), scale * section.shear, scale * section.bend);
  }
}

}  // namespace liana
