// Ids of grown and baked things: lineage, not counters. What was left out of a history renames nothing else.
#pragma once

#include <compare>
#include <cstdint>
#include <string_view>

namespace liana {

/// A bijection of 64-bit words that spreads every bit over all of them [Steele, Lea & Flood 2014,
/// splitmix64].
constexpr uint64_t mix_bits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// FNV-1a.
constexpr uint64_t hash_name(std::string_view name) {
  uint64_t hash = 14695981039346656037ull;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

/// Whose it is, of what kind, and the how many-th of that kind there, as 64 bits. Stays through cuts,
/// detaching, saving and loading. Of a million ids two are equal with a chance of 3e-8.
struct LineageId {
  uint64_t value = 0;  ///< 0: none

  constexpr bool valid() const { return value != 0; }
  constexpr auto operator<=>(const LineageId&) const = default;

  template <class Archive>
  void persist(Archive& a) {
    a(value);
  }
};

enum class LineageKind : uint8_t { Plant = 1, Branch, Segment, Leaf, Anchor };

/// Of a whole plant: parent of what stands in the ground.
constexpr LineageId plant_lineage(std::string_view name, uint64_t seed) {
  return {mix_bits(hash_name(name) ^ mix_bits(seed + static_cast<uint64_t>(LineageKind::Plant))) | 1};
}

/// `ordinal`: how many of this kind the parent had before, counting those that it has lost.
constexpr LineageId child_lineage(LineageId parent, LineageKind kind, uint64_t ordinal) {
  const uint64_t place = mix_bits(ordinal * 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(kind));
  const uint64_t value = mix_bits(parent.value ^ place);
  return {value != 0 ? value : 1};
}

}  // namespace liana
