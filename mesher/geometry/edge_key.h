// An edge as one number, for maps and sorted lists of edges.
#pragma once

#include <cstdint>
#include <utility>

namespace liana {

/// The directed edge from one vertex to another.
constexpr uint64_t directed_edge_key(uint32_t from, uint32_t to) {
  return uint64_t{from} << 32 | to;
}

/// The edge between two vertices, whichever way it runs.
constexpr uint64_t edge_key(uint32_t a, uint32_t b) {
  return a < b ? directed_edge_key(a, b) : directed_edge_key(b, a);
}

/// (from, to) of a directed edge; of an undirected one the smaller number first.
constexpr std::pair<uint32_t, uint32_t> edge_ends(uint64_t key) {
  return {static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key)};
}

}  // namespace liana
