// Secondary growth: stems thicken with what they carry (pipe model), at a limited rate.
#pragma once

#include <vector>

#include "runtime/sim/model/plant.h"

namespace liana {

struct ThickeningParameters {
  double exponent;      ///< n: rⁿ of a stem is the sum over what it carries
  double leaf_radius;   ///< m, that one leaf adds as a strand
  double largest_rate;  ///< 1/s, of the radius
};

/// The radius (m) every stem particle wants: young_radius[i] (m, 0 for leaves) at a tip, the sum of its
/// children's rⁿ below. Leaf particles get 0.
std::vector<double> pipe_radii(const Plant& plant, const std::vector<double>& young_radius, double exponent,
                               double leaf_radius);

/// One step of thickening over dt growth seconds: radius, mass and joint stiffness of every stem follow.
void thicken(Plant& plant, const std::vector<double>& young_radius, const std::vector<double>& joint_length,
             const ThickeningParameters& parameters, const ElasticMaterial& material, double dt);

}  // namespace liana
