// State as bytes. A class with state has one member template that names all of it,
//
//   template <class Archive> void persist(Archive& a) { a(first_, second_, third_); }
//
// and saving, loading and hashing go through that one list. Bytes are little endian, without padding; the
// same state has the same bytes. What is no state stands in a comment behind the list: `// not state: name,
// name: why` (a test compares list and comment with the members of the class).
#pragma once

#include <array>
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/base/state_bytes.h"
#include "mesher/base/types.h"

namespace liana {

/// Types whose bytes are their value: no padding, and every pattern of bits is a value. Arrays of them are
/// copied at once. Specialise it for a struct of which that holds.
template <class T>
inline constexpr bool kPlainBytes = std::is_same_v<T, float> || std::is_same_v<T, double> ||
                                    (std::is_integral_v<T> && !std::is_same_v<T, bool>);
template <class Tag>
inline constexpr bool kPlainBytes<Id<Tag>> = true;
template <>
inline constexpr bool kPlainBytes<LineageId> = true;
template <class Scalar, int kRows, int kColumns, int kOptions>
inline constexpr bool kPlainBytes<Eigen::Matrix<Scalar, kRows, kColumns, kOptions>> =
    kRows > 0 && kColumns > 0 && kPlainBytes<Scalar>;
template <class Scalar, int kOptions>
inline constexpr bool kPlainBytes<Eigen::Quaternion<Scalar, kOptions>> = kPlainBytes<Scalar>;
template <class T, size_t kSize>
inline constexpr bool kPlainBytes<std::array<T, kSize>> = kPlainBytes<T>;

/// Walks through values for one of the three below: Self has raw(data, size), count(n, bytes each), and
/// kReads. A pointer to const names an object that lives outside of the state: it is saved as a place in a
/// list of these (null is one of them), which must be the same when it is read.
template <class Self>
class Archive {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }
  void know(const void* object) { known_.push_back(object); }

 private:
  Self& self() { return static_cast<Self&>(*this); }

  template <class T>
  void value(T& v) {
    static_assert(std::endian::native == std::endian::little, "states are little endian");
    if constexpr (kPlainBytes<T>) {
      self().raw(&v, sizeof(T));
    } else if constexpr (std::is_same_v<T, bool>) {
      uint8_t byte = v;
      self().raw(&byte, 1);
      v = byte != 0;
    } else if constexpr (std::is_enum_v<T>) {
      auto number = static_cast<std::underlying_type_t<T>>(v);
      self().raw(&number, sizeof number);
      v = static_cast<T>(number);
    } else {
      v.persist(self());
    }
  }
  template <class T>
  void value(const T*& object) {
    uint32_t place = 0;
    if (object)
      while (place < known_.size() && known_[place] != object) ++place;
    else
      place = ~uint32_t{0};
    self().raw(&place, sizeof place);
    if (object || Self::kReads) check_known(place, known_.size());
    if constexpr (Self::kReads)
      object = place == ~uint32_t{0} ? nullptr : static_cast<const T*>(known_[place]);
  }
  template <class T, class Allocator>
  void value(std::vector<T, Allocator>& v) {
    const size_t n = self().count(v.size(), kPlainBytes<T> ? sizeof(T) : 1);
    if constexpr (Self::kReads) v.resize(n);
    elements(v.data(), n);
  }
  void value(std::string& v) {
    const size_t n = self().count(v.size(), 1);
    if constexpr (Self::kReads) v.resize(n);
    self().raw(v.data(), n);
  }
  template <class T, size_t kSize>
  void value(std::array<T, kSize>& v) {
    elements(v.data(), kSize);
  }
  template <class T, size_t kSize>
  void value(T (&v)[kSize]) {
    elements(v, kSize);
  }
  /// A fixed number of values that are there already.
  template <class T>
  void value(std::span<T>& v) {
    elements(v.data(), v.size());
  }
  template <class T>
  void elements(T* first, size_t n) {
    if constexpr (kPlainBytes<T>)
      self().raw(first, n * sizeof(T));
    else
      for (size_t i = 0; i < n; ++i) value(first[i]);
  }
  template <class First, class Second>
  void value(std::pair<First, Second>& v) {
    value(v.first), value(v.second);
  }
  /// An optional or a unique_ptr: what is there already is read in place.
  template <class Holder, class Make>
  void held(Holder& holder, const Make& make) {
    bool there = static_cast<bool>(holder);
    value(there);
    if constexpr (Self::kReads) {
      if (!there) holder.reset();
      if (there && !holder) make();
    }
    if (there) value(*holder);
  }
  template <class T>
  void value(std::optional<T>& v) {
    held(v, [&] {
      if constexpr (std::is_default_constructible_v<T>)
        v.emplace();
      else
        state_mismatch();
    });
  }
  template <class T>
  void value(std::unique_ptr<T>& v) {
    held(v, [&] {
      if constexpr (std::is_default_constructible_v<T>)
        v = std::make_unique<T>();
      else
        state_mismatch();
    });
  }
  template <class Key, class T>
  void value(std::map<Key, T>& v) {
    const size_t n = self().count(v.size(), 1);
    if constexpr (Self::kReads) {
      v.clear();
      for (size_t i = 0; i < n; ++i) {
        std::pair<Key, T> entry;
        value(entry);
        v.insert(v.end(), std::move(entry));
      }
    } else {
      for (auto& [key, mapped] : v) {
        Key copy = key;
        value(copy), value(mapped);
      }
    }
  }
  static void check_known(uint32_t place, size_t known);

  std::vector<const void*> known_;
};

/// Appends to bytes, whose memory is kept for the next time.
class StateWriter : public Archive<StateWriter> {
 public:
  static constexpr bool kReads = false;
  explicit StateWriter(StateBytes& out) : out_(out) {}
  void raw(const void* data, size_t size) { out_.append(data, size); }
  size_t count(uint64_t n, size_t) {
    raw(&n, sizeof n);
    return n;
  }

 private:
  StateBytes& out_;
};

/// Throws Error{Input} for bytes that end too early or are no such state.
class StateReader : public Archive<StateReader> {
 public:
  static constexpr bool kReads = true;
  explicit StateReader(std::span<const std::byte> bytes) : left_(bytes) {}
  void raw(void* data, size_t size) {
    if (size > left_.size()) state_mismatch();
    if (size > 0) std::memcpy(data, left_.data(), size);
    left_ = left_.subspan(size);
  }
  /// `each`: bytes that one takes at least.
  size_t count(uint64_t, size_t each) {
    uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > left_.size() / each) state_mismatch();
    return n;
  }
  void finish() const {
    if (!left_.empty()) state_mismatch();
  }

 private:
  std::span<const std::byte> left_;
};

/// One number for a state, the same for the same bytes.
class StateHasher : public Archive<StateHasher> {
 public:
  static constexpr bool kReads = false;
  void raw(const void* data, size_t size);
  size_t count(uint64_t n, size_t) {
    raw(&n, sizeof n);
    return n;
  }
  uint64_t hash();

 private:
  std::array<std::byte, 4096> waiting_;
  size_t used_ = 0;
  uint64_t hash_ = 0;
};

template <class Self>
void Archive<Self>::check_known(uint32_t place, size_t known) {
  if (place == ~uint32_t{0} || place < known) return;
  if (Self::kReads) state_mismatch();
  require(false, "an object that a state points to is not known to its archive");
}

}  // namespace liana
