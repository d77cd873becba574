// The world is wrong -> throw Error, caught in main and in the editor. Our own mistake -> require().
#pragma once

#include <stdexcept>
#include <string>

namespace liana {

/// What a user can be told: what is wrong (naming file and place) and what to do about it.
struct Error : std::runtime_error {
  enum class Kind { Usage, Input, Output, Cancelled, Partial };
  Kind kind;
  std::string hint;  ///< the next thing to do or type; may be empty

  Error(Kind of_kind, const std::string& what, std::string what_to_do = {})
      : std::runtime_error(what), kind(of_kind), hint(std::move(what_to_do)) {}
};

/// A condition that only a bug of ours can break.
inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace liana
