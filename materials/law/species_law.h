// The power laws of one species: what turns a length into frequency, mass, stiffness and damping.
//
// [Wang17] symbols: ℓ length (m); ν lowest natural frequency (Hz); ε₁, C₁ frequency law (Eq. 8); ε₂, C₂ mass
// scaling (Eq. 9); α_m, α_k mass and stiffness scaling (Eq. 9, 10); ξ modal damping factor (Eq. 12, 13); d_M
// (1/s), d_K (s) Rayleigh damping (Eq. 15); δ, κ change of damping under large deformation (Eq. 14).
#pragma once

#include <map>
#include <string>

#include "mesher/base/elastic_material.h"
#include "mesher/base/types.h"

namespace liana {

/// ξ(ν): constant below low_frequency and above high_frequency, linear between ([Wang17] Eq. 13).
struct DampingLaw {
  double low_frequency = 1.0;   ///< Hz
  double high_frequency = 3.0;  ///< Hz
  double low_factor = 0.0065;
  double high_factor = 0.1;
  double kappa = 2;  ///< > 1
  double delta = 2;  ///< in [1/kappa, kappa], so that d_M and d_K are not negative
};

/// The law of one material group. ν = reference_frequency (ℓ / reference_length)^epsilon1, α_m = C₂
/// ℓ^epsilon2.
struct GroupLaw {
  double reference_frequency = 1;  ///< Hz; equals C₁ when reference_length is 1 m
  double reference_length = 1;     ///< m
  double epsilon1 = -0.59;
  double c2 = 1;  ///< m^-epsilon2
  double epsilon2 = 0;
  DampingLaw damping = {};
};

/// What the law says of one domain.
struct DomainMaterial {
  double frequency;          ///< ν, Hz
  double mass_scaling;       ///< α_m
  double damping_factor;     ///< ξ
  double mass_damping;       ///< d_M, 1/s
  double stiffness_damping;  ///< d_K, s
};

struct SpeciesLaw {
  std::string species;
  ElasticMaterial default_material = {};
  std::map<std::string, GroupLaw> groups = {};  ///< "level0", "level1", ..., "leaf", or a name of the plant's own

  /// The law of a group; an unnamed "level<N>" takes the deepest level given above it. Throws Error when
  /// neither exists.
  const GroupLaw& group(const std::string& name) const;
};

/// [Wang17] Eq. 8, 9, 13, 15. length in m, > 0.
DomainMaterial evaluate(const GroupLaw& law, double length);

}  // namespace liana
