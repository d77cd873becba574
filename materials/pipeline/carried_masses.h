// The second step of a bake: what hangs on every domain, by the law, summed from the tips down.
#pragma once

#include "materials/pipeline/domain_solids.h"
#include "modal/elements/carried_mass.h"

namespace liana {

/// Per domain what its default solve carries: the mass of each child with all that hangs on it, Σ α_m ρ V,
/// where the child is attached, divided by the domain's own α_m (bake_plant.h says why).
std::vector<std::vector<CarriedMass>> carried_masses(const BakeJob& job,
                                                     const std::vector<DomainSolid>& solids,
                                                     const LeftOut& left_out);

}  // namespace liana
