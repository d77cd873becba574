// Lines, words and numbers of a text file, with the line's number for messages.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace liana {

/// The next line without its end (LF or CRLF); false at the end of the text.
class LineCursor {
 public:
  explicit LineCursor(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return true;
  }
  size_t number() const { return number_; }  ///< of the line last given, from 1
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  size_t number_ = 0;
};

constexpr std::string_view kBlanks = " \t\v\f\r";

inline std::string_view without_outer_blanks(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Takes the first word off a line; empty when there is none.
inline std::string_view take_word(std::string_view& line) {
  const size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return line = {};
  const size_t end = std::min(line.find_first_of(kBlanks, first), line.size());
  const std::string_view word = line.substr(first, end - first);
  line.remove_prefix(end);
  return word;
}

/// The whole word as a number; a leading + is allowed, as in files written by printf("%+g").
template <class Number>
std::optional<Number> to_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// A word as it may be shown in a message: short and printable.
inline std::string shown(std::string_view word) {
  std::string text(word.substr(0, 24));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return word.size() > 24 ? text + "..." : text;
}

}  // namespace liana
