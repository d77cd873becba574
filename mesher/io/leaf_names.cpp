#include "mesher/io/leaf_names.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

namespace liana {
namespace {

bool has_word(const std::string& name, std::initializer_list<std::string_view> words) {
  std::string lower(name.size(), ' ');
  std::transform(name.begin(), name.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto is_letter = [&](size_t i) { return i < lower.size() && std::isalpha((unsigned char)lower[i]); };
  for (const std::string_view word : words)
    for (size_t at = lower.find(word); at != std::string::npos; at = lower.find(word, at + 1))
      if (at == 0 || (!is_letter(at - 1) && !is_letter(at + word.size()))) return true;
  return false;
}

}  // namespace

bool named_as_leaf(const std::string& name) {
  return has_word(name, {"leaf", "leaves", "blade", "petal", "foliage", "frond", "needle", "flower"});
}

bool named_as_branch(const std::string& name) {
  return has_word(name, {"bark", "trunk", "branch", "stem", "twig", "wood", "shoot"});
}

}  // namespace liana
