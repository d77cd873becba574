// Numbers and texts as little-endian bytes, and back with every length checked first.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "mesher/base/error.h"

namespace liana {

static_assert(std::endian::native == std::endian::little,
              "the byte streams copy numbers as they lie in memory");

class ByteWriter {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void text(std::string_view text) {
    number(static_cast<uint32_t>(text.size()));
    bytes_.append(text);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Throws Error{Input} "<name>: ... at byte N" instead of reading past the end.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  std::string text() {
    const uint32_t size = number<uint32_t>();
    return {take(size), size};
  }
  /// A count of items that take at least `least_bytes` each, so that no count can exceed what the bytes can
  /// hold.
  uint32_t count(size_t least_bytes) {
    const uint32_t count = number<uint32_t>();
    if (count > left() / least_bytes)
      fail("a count of " + std::to_string(count) + " is more than the file can hold");
    return count;
  }
  void skip(size_t size) { take(size); }
  size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Error::Kind::Input, name_ + ": " + what + " (at byte " + std::to_string(at_) + ")",
                "the file is damaged; make it again");
  }

 private:
  const char* take(size_t size) {
    if (size > left()) fail("ends too early");
    const char* data = bytes_.data() + at_;
    at_ += size;
    return data;
  }

  std::string_view bytes_;
  size_t at_ = 0;
  std::string name_;
};

}  // namespace liana
