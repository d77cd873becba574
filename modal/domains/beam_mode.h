// The lowest modes of a domain that is no solid, as a beam: [Timoshenko 1921] bending with shear and rotary
// inertia, stretch and torsion, along a line in space with elliptic sections.
#pragma once

#include <span>

#include "modal/domains/beam_sections.h"
#include "modal/solve/lowest_mode.h"

namespace liana {

/// Held at the first section, free at the last. `volume` (m³, 0: unknown): where the sections hold more, the
/// beam ends where they have held so much, so that a line that runs on beyond the solid's end does not bend
/// it softer. A carried mass sits on a rigid arm from the nearest point of the line. At most four modes.
/// Against the closed forms of cantilevers within 0.1 %; against the solids of bent and tapered branches
/// within 3 %. Throws Error{Input} if the line has no length or a section no size.
Modes beam_modes(std::span<const Section> line, double volume, const ElasticMaterial& material,
                 std::span<const CarriedMass> carried, int modes = 2);

}  // namespace liana
