// From the sections of a solid to what the bake says of its shape.
#pragma once

#include <vector>

#include "materials/bake/bake.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// `soft` (unit: where the lowest bending goes) made perpendicular to the line from root to tip; the first
/// section's thin axis where the two coincide. Of the two signs the one whose largest component is positive.
Vec3 flat_normal(const std::vector<Section>& sections, const Vec3& soft);

/// The sections with half axes along and across `normal`: those of an ellipse with the same second moments
/// about these two directions.
std::vector<Station> stations(const std::vector<Section>& sections, const Vec3& normal);

/// Mean of [Wang17] Eq. 11 over the volume along the centreline: what the taper makes of the mass.
double mean_taper(const std::vector<Section>& sections, const TaperLaw& law);

}  // namespace liana
