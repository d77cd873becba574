// Frequency, mass and stiffness of a domain by its length: [Wang17] §4.
//
// ℓ length (m); ν frequency (Hz); α_m, α_k scaling of the default material's density and Young's modulus.
#pragma once

#include "materials/law/species_law.h"

namespace liana {

/// [Wang17] Eq. 8: ν = C₁ ℓ^ε₁, Hz.
double frequency_of_length(const GroupLaw& law, double length);

/// [Wang17] Eq. 9: α_m = C₂ ℓ^ε₂.
double mass_scaling_of_length(const GroupLaw& law, double length);

/// [Wang17] Eq. 10: the α_k with which a domain of ν_default and α_m swings at ν.
double stiffness_scaling(double mass_scaling, double frequency, double default_frequency);

/// Stiffening and lightening along one domain, [Wang17] Eq. 11.
struct TaperLaw {
  double root_scaling = 1;  ///< s_max
  double tip_scaling = 1;   ///< s_min
  double epsilon3 = 2;
};

/// [Wang17] Eq. 11: factor on E and ρ at geodesic distance `fraction` · ℓ from the root, fraction in [0, 1].
double taper_scaling(const TaperLaw& law, double fraction);

}  // namespace liana
