// The first step of a bake: every domain made solid, once for each shape.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "materials/cache/instances.h"
#include "materials/pipeline/bake_job.h"
#include "materials/pipeline/left_out.h"

namespace liana {

/// A domain made solid, and its law evaluated at its length.
struct DomainSolid {
  SolidDomain solid;  ///< without surface if it came from the cache and its modes are likely to be there too
  DomainMaterial material{};
  TaperLaw taper;
  Instance instance;       ///< of an earlier domain, or of itself
  uint64_t cache_key = 0;  ///< 0: not to be kept
  bool from_cache = false;
  std::string failure;  ///< why there is none; empty if there is
};

/// One for each domain. Copies are moved; what the cache knows is taken from it and what is new is put there.
/// Throws Error{Cancelled}.
std::vector<DomainSolid> make_solids(const BakeJob& job);

/// Those that could not be made solid.
LeftOut failures_of(const std::vector<DomainSolid>& solids);

/// The solid made anew if it came without its surface; else nothing.
std::optional<SolidDomain> missing_surface(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                           size_t index);

/// m³: the volume by the mean of [Wang17] Eq. 11 along it; times density it is the domain's default mass.
double weighed_volume(const DomainSolid& domain);

}  // namespace liana
