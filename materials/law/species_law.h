// The power laws of one species: what turns a length into frequency, mass, stiffness and damping.
//
// [Wang17] symbols: ℓ length (m); ν lowest natural frequency (Hz); ε₁, C₁ frequency law (Eq. 8); ε₂, C₂ mass
// scaling (Eq. 9); α_m, α_k mass and stiffness scaling (Eq. 9, 10); ξ modal damping factor (Eq. 12, 13); d_M
// (1/s), d_K (s) Rayleigh damping (Eq. 15); δ, κ change of damping under large deformation (Eq. 14).
#pragma once

#include <map>
#include <optional>
#include <string>

#include "mesher/base/types.h"
#include "modal/material/elastic_material.h"
#include "modal/material/taper_law.h"

namespace liana {

/// ξ(ν): constant below low_frequency and above high_frequency, linear between ([Wang17] Eq. 13); or, as most
/// of the paper's own examples (Table 1), the same d_M and d_K for every domain.
struct DampingLaw {
  double low_frequency = 1.0;   ///< Hz
  double high_frequency = 3.0;  ///< Hz
  double low_factor = 0.0065;
  double high_factor = 0.1;
  double kappa = 2;                ///< > 1
  double delta = 2;                ///< in [1/kappa, kappa], so that d_M and d_K are not negative
  bool constant_rayleigh = false;  ///< then the two below hold, and none of the above
  double mass_damping = 0;         ///< d_M, 1/s
  double stiffness_damping = 0;    ///< d_K, s
};

/// Which domains a group claims beside those that the plant gives its name: those that meet all that is
/// given.
struct GroupMatch {
  std::string name;  ///< pattern of domain names: * any text, ? one letter, [ab] one of these; empty: any
  std::optional<DomainKind> kind = {};
  int level = -1;  ///< -1: any

  bool empty() const { return name.empty() && !kind && level < 0; }
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
  double median_frequency = 0;  ///< ν_med, Hz, of the median model; 0: what Eq. 8 gives at the median length
  double modulus_of_rupture = 0;  ///< Pa, bending stress at which it breaks; 0: not known
  GroupMatch match = {};
  TaperLaw taper = {};  ///< of stiffness and density along each domain; uniform unless given
};

/// What the law says of one domain.
struct DomainMaterial {
  double frequency;          ///< ν, Hz
  double mass_scaling;       ///< α_m
  double damping_factor;     ///< ξ
  double mass_damping;       ///< d_M, 1/s
  double stiffness_damping;  ///< d_K, s

  template <class Archive>
  void persist(Archive& a) {
    a(frequency, mass_scaling, damping_factor, mass_damping, stiffness_damping);
  }
};

/// How ν follows from a domain: by [Wang17]'s own law, or by one of those it compares itself with. What mass
/// and damping follow from it is the same for all.
enum class MaterialModel : uint8_t {
  PowerLaw,  ///< ν = C₁ ℓ^ε₁ (Eq. 8)
  Constant,  ///< one Young's modulus for all, so that the main trunk has a given ν (§3)
  Depth,     ///< stiffness scaled by s μ^level: ν = ν_default √(s μ^level) (§3, §4.4)
  Median,    ///< ν = ν_med ℓ_med / ℓ, of the median length in the group (§4.4)
};

/// The model and what it needs beside the groups' numbers.
struct ModelLaw {
  MaterialModel model = MaterialModel::PowerLaw;
  double trunk_frequency = 0;   ///< Hz, constant model; 0: what Eq. 8 gives the main trunk
  double depth_scale = 0;       ///< s, depth model; 0: so that the main trunk has the ν of Eq. 8
  double depth_discount = 0.1;  ///< μ in (0, 1], depth model; 0.1 as [Wang17] §7 recommends
};

struct SpeciesLaw {
  std::string species;
  ElasticMaterial default_material = {};
  ModelLaw model = {};
  std::map<std::string, GroupLaw> groups =
      {};  ///< "level0", "level1", ..., "leaf", or a name of the plant's own

  /// The law of a group; an unnamed "level<N>" takes the deepest level given above it. Throws Error when
  /// neither exists.
  const GroupLaw& group(const std::string& name) const;

  /// Which group a domain of this name, kind and level is in, which the plant puts into `given`. A match by
  /// name goes before one by level, that before one by kind, and any before a law taken from the level above;
  /// `given` itself counts as a level. Throws Error{Input} when two groups claim the domain with equal right,
  /// or none does.
  std::string group_of(const std::string& name, DomainKind kind, int level, const std::string& given) const;
};

/// Pa, of a group; 0 when it is not known, or the law has no such group.
double modulus_of_rupture(const SpeciesLaw& law, const std::string& group);

/// [Wang17] Eq. 8, 9, 13, 15. length in m, > 0. Throws Error{Input} when there is no such material.
DomainMaterial evaluate(const GroupLaw& law, double length);

/// The same with another ν (Hz) than that of Eq. 8: what the other models say.
DomainMaterial evaluate_at(const GroupLaw& law, double length, double frequency);

}  // namespace liana
