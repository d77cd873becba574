// The last step of a bake: frequencies by the material model, and stiffness and density that give them.
#pragma once

#include "materials/pipeline/find_modes.h"

namespace liana {

/// The law's answer for every domain, by whichever model the species names.
struct ChosenMaterials {
  std::vector<DomainMaterial> materials;  ///< per domain of the plant
  std::vector<std::string> notes;         ///< what the species left open, and what was taken
};
ChosenMaterials choose_materials(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                 const std::vector<DomainModes>& modes, const LeftOut& left_out);

/// Per domain of the plant its id in the bake: ids count those that stayed. Invalid for the others.
std::vector<DomainId> ids_in_bake(size_t domains, const LeftOut& left_out);

/// [Wang17] Eq. 10: the domains that stayed, scaled so that each swings at its material's frequency.
Bake apply_laws(const BakeJob& job, const std::vector<DomainSolid>& solids,
                const std::vector<DomainModes>& modes, const std::vector<DomainMaterial>& materials,
                const LeftOut& left_out);

}  // namespace liana
