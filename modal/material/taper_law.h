// Stiffening and lightening along one domain, [Wang17] §4.5.
#pragma once

#include <cmath>

#include "mesher/base/fixed_math.h"

namespace liana {

struct TaperLaw {
  double root_scaling = 1;  ///< s_max
  double tip_scaling = 1;   ///< s_min
  double epsilon3 = 2;

  bool uniform() const { return root_scaling == tip_scaling && root_scaling == 1; }
  bool operator==(const TaperLaw&) const = default;
};

/// [Wang17] Eq. 11: factor on E and ρ at geodesic distance `fraction` · ℓ from the root, fraction in [0, 1].
inline double taper_scaling(const TaperLaw& law, double fraction) {
  const double t = fixed::pow(1 - fraction, law.epsilon3);
  return (1 - t) * law.tip_scaling + t * law.root_scaling;
}

}  // namespace liana
