// What a user should know of a bake though nothing failed.
#pragma once

#include "materials/pipeline/find_modes.h"

namespace liana {

/// One line each: what mending cost, which sheets are only rough beams, which groups borrow a law, and where
/// damping is not monotonic.
std::vector<std::string> bake_notes(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                    const std::vector<DomainModes>& modes, const LeftOut& left_out);

}  // namespace liana
