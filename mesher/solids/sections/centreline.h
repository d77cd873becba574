// The line through the middle of a domain and its cross-sections.
#pragma once

#include <vector>

#include "mesher/solids/solidify/grade.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// Sections from the root to the tip: centres are the middles of the contours of equal distance from the
/// root, shapes those of plane cuts across the line through them. 8 to 24 of them by length over diameter.
std::vector<Section> find_centreline(const MarkedSurface& solid, const Vec3& root, double length,
                                     double diameter);

}  // namespace liana
