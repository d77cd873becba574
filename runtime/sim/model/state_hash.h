// One number for where a plant is and how it moves: equal runs have equal hashes.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// XXH3 over the numbers of every particle's Motion, in order, without padding. Chain over plants with
/// `seed`.
uint64_t state_hash(const Plant& plant, uint64_t seed = 0);

}  // namespace liana
