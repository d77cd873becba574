// "Did you mean ...?": the candidate with the smallest edit distance.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace liana {

/// Levenshtein distance, in single-character edits.
inline size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

/// Empty when there are no candidates.
inline std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  const auto nearest = std::min_element(
      candidates.begin(), candidates.end(),
      [&](const auto& a, const auto& b) { return edit_distance(word, a) < edit_distance(word, b); });
  return nearest == candidates.end() ? std::string() : *nearest;
}

}  // namespace liana
