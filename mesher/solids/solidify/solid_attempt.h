// One try at making a surface solid: the rungs of the ladder call it with better and better surfaces.
#pragma once

#include "mesher/solids/solidify/parent_surface.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// What a try found out, whether it succeeded or not.
struct Attempt {
  double kept = 1;         ///< share of the surface's area in the part that was taken
  double lost_volume = 0;  ///< m³ in the other parts
  bool is_sheet = false;   ///< it was taken for a sheet
  Mesh crossing;  ///< closed and oriented, but passes through itself; empty if that was not the reason
};

/// clean_shell, then lids or a sheet's thickness, root, rings, centreline. Throws Error{Input}.
SolidDomain attempt_solid(const Domain& domain, const Mesh& surface, const ParentSurface& support,
                          Attempt& attempt);

}  // namespace liana
