// 64-bit content hashes (XXH3): file provenance, bake checksums, state hashes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace liana {

uint64_t hash_bytes(const void* data, size_t size, uint64_t seed = 0);

template <class T>
uint64_t hash_span(std::span<const T> values, uint64_t seed = 0) {
  static_assert(std::is_trivially_copyable_v<T>);
  return hash_bytes(values.data(), values.size_bytes(), seed);
}

std::string hash_text(uint64_t hash);  ///< 16 lower-case hexadecimal digits

}  // namespace liana
