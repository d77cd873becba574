// Solids out of the cache and into it, and which domains are copies.
#pragma once

#include "materials/pipeline/domain_solids.h"

namespace liana {

/// What is known before any solid is made: those in the cache, and of the others which is a copy of which.
std::vector<DomainSolid> recall_solids(const BakeJob& job);

/// Puts those into the cache that did not come from it.
void remember_solids(const BakeJob& job, const std::vector<DomainSolid>& solids);

}  // namespace liana
