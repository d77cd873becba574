// Modal damping of a domain and the Rayleigh coefficients that give it: [Wang17] §5.
//
// ν frequency (Hz); ξ modal damping factor (Eq. 12); d_M (1/s), d_K (s) Rayleigh damping D = d_M M + d_K K;
// δ, κ: ξ becomes δ ξ where the structure has stiffened so that ν became κ ν (Eq. 14).
#pragma once

#include "materials/law/species_law.h"

namespace liana {

struct RayleighDamping {
  double mass;       ///< d_M, 1/s
  double stiffness;  ///< d_K, s
};

/// [Wang17] Eq. 12: ξ of a mode of frequency ν. At κν it is the left side of Eq. 14.
double modal_damping_factor(const RayleighDamping& damping, double frequency);

/// [Wang17] Eq. 13: ξ(ν); Eq. 12 where d_M and d_K are constant.
double damping_factor(const DampingLaw& law, double frequency);

/// [Wang17] Eq. 15: the d_M and d_K with which Eq. 12 gives ξ at ν and Eq. 14 gives δ ξ at κν; or the
/// law's own where they are constant.
RayleighDamping rayleigh_damping(const DampingLaw& law, double frequency, double factor);

/// [Wang17] Eq. 16: ν*, Hz, the frequency at which ξ is least. 0 for δ = κ, infinite for δ = 1/κ.
double least_damped_frequency(const DampingLaw& law, double frequency);

/// Whether ξ changes monotonically while the structure stiffens from ν to κν: δ in [1/κ, 2κ/(κ²+1)] or
/// [(κ²+1)/(2κ), κ] ([Wang17] §5, after Eq. 16). True where d_M and d_K are constant.
bool is_monotonic(const DampingLaw& law);

}  // namespace liana
