// Pieces of text.
#pragma once

#include <string_view>

namespace liana {

constexpr std::string_view kBlanks = " \t\v\f\r";

inline std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace liana
