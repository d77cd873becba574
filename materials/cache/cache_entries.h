// The entries of a bake's cache: what they depend on and what is in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "materials/cache/instances.h"
#include "modal/domains/domain_modes.h"

namespace liana {

/// A copy, by the key of its source.
struct CachedCopy {
  uint64_t source_key;
  Similarity similarity;
};

/// Everything the solid of a domain depends on: its surface and what it hangs on.
std::vector<uint64_t> geometry_keys(const SegmentedPlant& plant);

std::string encode(const CachedCopy& copy);
std::string encode(const SolidDomain& solid, bool with_surface);
/// Without surface when it was encoded so.
std::variant<CachedCopy, SolidDomain> decode_geometry(std::string_view bytes);

/// Everything modes depend on but Young's modulus and density: the carried masses enter as volumes of the
/// default material, to 12 digits, as rounding differs with how the law came by them.
uint64_t modes_key(uint64_t geometry_key, const Solid& solid, const ElasticMaterial& material,
                   const DomainModesOptions& options);

struct CachedModes {
  uint64_t source_key;  ///< modes_key of the domain that was solved
  DomainModes modes;    ///< but for solved_as
};

/// Frequencies are kept for the material they were found with and scale with √(E/ρ).
std::string encode(const CachedModes& modes, const ElasticMaterial& material);
CachedModes decode_modes(std::string_view bytes, const ElasticMaterial& material);

}  // namespace liana
