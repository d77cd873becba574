// The line and sections of a branch or leaf whose surface cannot be made solid.
#pragma once

#include <optional>

#include "mesher/plant/segmented_plant.h"
#include "mesher/solids/solidify/parent_surface.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// A domain as a beam: sections by the moments of its surface in slices of equal distance from the root, and
/// a tube with these sections as its surface (for pictures; it may pass through itself). Exact for straight
/// prismatic tubes: the mean square distance of a regular polygon's outline from its middle is four times its
/// area's squared radius of gyration. A slice that is flat counts as a sheet of the domain's thickness.
/// Nothing if the surface has no length or no width, a branch no thickness, or a
/// slice several strands (a ring).
std::optional<SolidDomain> beam_shape(const Domain& domain, const ParentSurface& support);

/// The tube through elliptic sections, eight sides, closed, outward; the root lid's triangles come last.
Mesh tube_through(const std::vector<Section>& sections);

}  // namespace liana
