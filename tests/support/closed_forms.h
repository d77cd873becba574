// Frequencies that are known without a computer.
#pragma once

#include <cmath>

#include "mesher/base/types.h"
#include "modal/material/elastic_material.h"
#include "tests/support/solids/shapes.h"

namespace liana {

/// Hz. Euler-Bernoulli cantilever of the n-gon's own I and A: f = 1.8751² / (2π ℓ²) √(E I / (ρ A)).
inline double cantilever_frequency(int sides, double length, double diameter, const ElasticMaterial& m = {}) {
  return 3.5160152685 / (2 * kPi * length * length) *
         std::sqrt(m.youngs_modulus * polygon_second_moment(sides, diameter) /
                   (m.density * polygon_area(sides, diameter)));
}

/// f / f₀ of a cantilever with a point mass μ times its own at the tip: the least root b of
/// 1 + cos b cosh b + μ b (cos b sinh b − sin b cosh b) = 0, squared over 1.8751².
inline double tip_mass_ratio(double mu) {
  const auto f = [mu](double b) {
    return 1 + std::cos(b) * std::cosh(b) +
           mu * b * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  double low = 0, high = 1.8751040687;
  for (int i = 0; i < 100; ++i) (f((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return std::pow(low / 1.8751040687, 2);
}

}  // namespace liana
