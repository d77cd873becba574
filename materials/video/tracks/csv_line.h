// Lines and fields of plain CSV text: commas, spaces around fields ignored, quotes around a whole field taken
// off.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace liana {

inline std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

inline bool is_blank(std::string_view text) {
  return trimmed(text).empty();
}

inline std::vector<std::string> split_csv_line(std::string_view line) {
  std::vector<std::string> fields;
  for (size_t from = 0; from <= line.size();) {
    const size_t comma = std::min(line.find(',', from), line.size());
    std::string_view field = trimmed(line.substr(from, comma - from));
    if (field.size() > 1 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.emplace_back(field);
    from = comma + 1;
  }
  return fields;
}

/// The whole text as a number ("nan" and "inf" are numbers); nothing when it is none.
inline std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// At most 40 characters, none of them able to upset a terminal.
inline std::string printable(std::string_view text) {
  std::string out(text.substr(0, 40));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return out;
}

/// visit(line without its end, number from 1).
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  for (size_t number = 1; !text.empty(); ++number) {
    const size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end), number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace liana
