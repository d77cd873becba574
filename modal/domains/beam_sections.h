// The cross-sections that a beam is laid through.
#pragma once

#include <span>
#include <vector>

#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// m²: its own, or that of its ellipse.
double area_of(const Section& section);

/// Between a (part 0) and b (part 1).
Section between(const Section& a, const Section& b, double part);

/// `count` + 1 sections, evenly along the line, up to where they hold `volume` (m³; 0: to the end). Throws
/// Error{Input} if the line has no length or a section no size.
std::vector<Section> resample(std::span<const Section> line, double volume, int count);

/// A centreline as find_centreline() gives it has its first and last section cut half a step inside; here
/// their sizes are carried on to the ends.
std::vector<Section> carried_to_ends(std::span<const Section> line);

}  // namespace liana
