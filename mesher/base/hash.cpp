#include "mesher/base/hash.h"

#include <fmt/core.h>
#include <xxhash.h>

namespace liana {

uint64_t hash_bytes(const void* data, size_t size, uint64_t seed) {
  return XXH3_64bits_withSeed(data, size, seed);
}

std::string hash_text(uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace liana
