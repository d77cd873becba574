// One number for where a plant is and how it moves: equal runs have equal hashes.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// The sum of XXH3 over the numbers of every particle's Motion, each with its lineage (its slot in plants
/// without): the same whatever the order of the arrays. Chain over plants with `seed`.
uint64_t state_hash(const Plant& plant, uint64_t seed = 0);

}  // namespace liana
