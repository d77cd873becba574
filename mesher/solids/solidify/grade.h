// Rings near the root: where the clamp bends a branch, the mesh must be fine along it.
#pragma once

#include <vector>

#include "mesher/solids/solidify/line_cut.h"

namespace liana {

/// Distances at which a clamped branch wants rings: 0.5 d, 1.5 d, 3.5 d, ... while steps are below length/6,
/// then even steps of at most length/6. Ascending, without 0 and length; none when
/// the length is 0 or not finite.
std::vector<double> ring_levels(double length, double diameter);

/// Splits triangles along the iso-lines of `distance` at ring_levels, where they are longer than the rings
/// are apart. The shape does not change: every new vertex lies on an edge. A vertex near a line serves as it
/// is. Returns the number of lines cut.
int grade(MarkedSurface& surface, double length, double diameter);

}  // namespace liana
