// Bytes that grow by appending and keep their memory when they are emptied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "mesher/base/error.h"

namespace liana {

/// Unlike a vector it does not fill with zeros what is about to be written.
class StateBytes {
 public:
  StateBytes() = default;
  explicit StateBytes(std::span<const std::byte> bytes) { append(bytes.data(), bytes.size()); }
  StateBytes(const StateBytes& other) : StateBytes(other.view()) {}
  StateBytes(StateBytes&& other) noexcept { swap(other); }
  StateBytes& operator=(StateBytes other) noexcept {
    swap(other);
    return *this;
  }

  void append(const void* data, size_t size) {
    if (size > capacity_ - size_) grow(size);
    if (size > 0) std::memcpy(memory_.get() + size_, data, size);
    size_ += size;
  }
  void clear() { size_ = 0; }
  void swap(StateBytes& other) noexcept {
    std::swap(memory_, other.memory_), std::swap(size_, other.size_), std::swap(capacity_, other.capacity_);
  }

  std::byte* data() { return memory_.get(); }
  const std::byte* data() const { return memory_.get(); }
  size_t size() const { return size_; }
  std::span<const std::byte> view() const { return {memory_.get(), size_}; }
  friend bool operator==(const StateBytes& a, const StateBytes& b) {
    return a.size_ == b.size_ && (a.size_ == 0 || std::memcmp(a.data(), b.data(), a.size_) == 0);
  }

 private:
  void grow(size_t by);

  std::unique_ptr<std::byte[]> memory_;
  size_t size_ = 0, capacity_ = 0;
};

/// What reading a state throws when it does not fit: Error{Input}.
[[noreturn]] void state_mismatch();

}  // namespace liana
