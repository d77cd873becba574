// Frequency, mass and stiffness of a domain by its length: [Wang17] §4.
//
// ℓ length (m); ν frequency (Hz); α_m, α_k scaling of the default material's density and Young's modulus.
#pragma once

#include "materials/law/species_law.h"
#include "modal/material/taper_law.h"

namespace liana {

/// [Wang17] Eq. 8: ν = C₁ ℓ^ε₁, Hz.
double frequency_of_length(const GroupLaw& law, double length);

/// [Wang17] Eq. 9: α_m = C₂ ℓ^ε₂.
double mass_scaling_of_length(const GroupLaw& law, double length);

/// [Wang17] Eq. 10: the α_k with which a domain of ν_default and α_m swings at ν.
double stiffness_scaling(double mass_scaling, double frequency, double default_frequency);

}  // namespace liana
