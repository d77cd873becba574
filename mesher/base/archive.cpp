#include "mesher/base/archive.h"

#include <algorithm>

#include "mesher/base/hash.h"

namespace liana {

void StateBytes::grow(size_t by) {
  const size_t capacity = std::max(size_ + by, 2 * capacity_);
  std::unique_ptr<std::byte[]> memory(new std::byte[capacity]);
  if (size_ > 0) std::memcpy(memory.get(), memory_.get(), size_);
  memory_ = std::move(memory);
  capacity_ = capacity;
}

void state_mismatch() {
  throw Error(Error::Kind::Input, "the saved state is damaged, or was saved by another version",
              "save it again with this version");
}

void StateHasher::raw(const void* data, size_t size) {
  const auto* bytes = static_cast<const std::byte*>(data);
  while (size > 0) {
    const size_t part = std::min(size, waiting_.size() - used_);
    std::memcpy(waiting_.data() + used_, bytes, part);
    used_ += part, bytes += part, size -= part;
    if (used_ < waiting_.size()) continue;
    hash_ = hash_bytes(waiting_.data(), used_, hash_);
    used_ = 0;
  }
}

uint64_t StateHasher::hash() {
  hash_ = hash_bytes(waiting_.data(), used_, hash_);
  used_ = 0;
  return hash_;
}

}  // namespace liana
