// [Wang17] Eq. 11 on the tets of a domain.
#pragma once

#include <vector>

#include "mesher/tets/tet_mesh.h"
#include "modal/elements/assembly.h"
#include "modal/material/taper_law.h"

namespace liana {

/// Factor s_i on E and ρ for each tet: the law at ℓ_i / ℓ, ℓ_i the mean over the tet's corners of the
/// geodesic distance from the root faces, ℓ the largest distance. Distances run along the boundary; a corner
/// inside takes the mean of its neighbours. Throws Error{Input} when no face is held.
std::vector<ElementScaling> tapered(const TetMesh& mesh, const TaperLaw& law);

/// Σ s_i V_i / Σ V_i: what the taper makes of the domain's mass.
double mean_density_scaling(const TetMesh& mesh, std::span<const ElementScaling> scaling);

}  // namespace liana
