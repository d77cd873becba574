// The third step of a bake: the modes of every domain with what it carries.
#pragma once

#include "materials/pipeline/carried_masses.h"
#include "modal/domains/domain_modes.h"

namespace liana {

struct FoundModes {
  std::vector<DomainModes> modes;            ///< per domain of the plant, where it is not left out
  std::vector<std::string> failures;         ///< per domain, why it has none; else empty
  double tet_seconds = 0, mode_seconds = 0;  ///< summed over the workers
};

/// With the default material. Copies that carry nothing take the modes of what they are copies of; what the
/// cache knows is taken from it and what is new is put there. Throws Error{Cancelled}.
FoundModes find_modes(const BakeJob& job, const std::vector<DomainSolid>& solids,
                      const std::vector<std::vector<CarriedMass>>& carried, const LeftOut& left_out);

}  // namespace liana
