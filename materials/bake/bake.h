// What the runtime needs to know of a plant, and nothing else.
#pragma once

#include <string>
#include <vector>

#include "materials/law/species_law.h"

namespace liana {

/// A cross-section of a domain, taken along its centreline.
struct Station {
  Vec3 position;          ///< m, plant frame
  double half_width;      ///< m, along the wide axis
  double half_thickness;  ///< m, along BakedDomain::flat_normal
};

struct BakedDomain {
  std::string name;
  DomainId parent;  ///< invalid for a trunk; parents come before children
  DomainKind kind = DomainKind::Branch;
  int level = 0;
  std::string group;

  double length = 0;  ///< ℓ, m, longest geodesic from the root
  double mass = 0;    ///< kg, its own, after mass scaling
  uint32_t tets = 0, dof = 0;
  double default_frequency = 0;  ///< ν_default, Hz, with the default material
  DomainMaterial material;
  double stiffness_scaling = 1;  ///< α_k
  double youngs_modulus = 0;     ///< Pa, α_k E_default
  double density = 0;            ///< kg/m³, α_m ρ_default
  std::string route;             ///< how its surface was made solid
  DomainId solved_as;            ///< the domain whose modes it shares (itself if none)

  std::vector<Station> centreline;   ///< from root to tip, at least 2
  Vec3 flat_normal = Vec3::UnitZ();  ///< unit; the direction the lowest mode bends to
  double stiffness_ratio = 1;        ///< (ν₂/ν₁)² of its two lowest bending modes: 1 for a round rod
};

struct Bake {
  std::string plant;  ///< name of the plant file
  uint64_t plant_hash = 0;
  uint64_t species_hash = 0;
  SpeciesLaw law;
  std::vector<BakedDomain> domains;
  std::vector<std::string> failed;  ///< domains that could not be made solid, with the reason
};

}  // namespace liana
