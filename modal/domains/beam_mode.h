// The lowest modes of a domain that is no solid, as a beam: [Timoshenko 1921] bending with shear and rotary
// inertia, stretch and torsion, along a line in space with elliptic sections.
//
//   A, I_w, I_t   area (m²) and second moments (m⁴) of a section: π a³ b / 4 and π a b³ / 4 of half axes a >
//   b J             torsion constant of the ellipse, π a³ b³ / (a² + b²), m⁴ κ             shear factor 6 (1
//   + ν) / (7 + 6 ν) ([Cowper 1966], circle) Φ             12 E I / (κ G A h²) of an element of length h: its
//   share of shear
#pragma once

#include <span>

#include "mesher/solids/solidify/solid_domain.h"
#include "modal/solve/lowest_mode.h"

namespace liana {

/// Held at the first section, free at the last. `volume` (m³, 0: unknown): where the sections hold more, the
/// beam ends where they have held so much, so that a line that runs on beyond the solid's end does not bend
/// it softer. A carried mass sits on a rigid arm from the nearest point of the line. Against the closed forms
/// of cantilevers within 0.1 %; against the solids of bent and tapered branches within 3 %. Throws
/// Error{Input} if the line has no length or a section no size.
Modes beam_modes(std::span<const Section> line, double volume, const ElasticMaterial& material,
                 std::span<const CarriedMass> carried, int modes = 2);

/// A centreline as find_centreline() gives it has its first and last section cut half a step inside; here
/// their sizes are carried on to the ends.
std::vector<Section> carried_to_ends(std::span<const Section> line);

}  // namespace liana
