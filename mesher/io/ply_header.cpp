#include "mesher/io/ply_header.h"

#include <fmt/core.h>

#include "mesher/base/error.h"
#include "mesher/io/text_cursor.h"

namespace liana {
namespace {

constexpr size_t kMaxHeaderLines = 10'000;

std::optional<PlyType> type_named(std::string_view name) {
  static constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
      {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
      {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
      {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
      {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
      {"float64", PlyType::Float64}};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
}

}  // namespace

size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
      return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
      return 2;
    case PlyType::Float64:
      return 8;
    default:
      return 4;
  }
}

int PlyElement::find(std::string_view property) const {
  for (size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

size_t PlyElement::least_bytes(PlyFormat format) const {
  size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += format == PlyFormat::Ascii ? 1 : size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
  LineCursor lines(bytes);
  const auto error = [&](const std::string& reason) {
    return Error(Error::Kind::Input, fmt::format("{}:{}: {}", file, lines.number(), reason),
                 "export it again as PLY 1.0, ASCII or binary");
  };
  PlyHeader header;
  std::string_view line;
  if (!lines.next(line) || without_outer_blanks(line) != "ply") throw error("does not start with 'ply'");
  bool has_format = false;
  while (lines.number() < kMaxHeaderLines && lines.next(line)) {
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") {
      if (!has_format) throw error("the header names no format");
      header.bytes = bytes.size() - lines.rest().size(), header.lines = lines.number();
      return header;
    }
    if (keyword == "format") {
      const std::string_view format = take_word(line);
      if (format == "ascii")
        header.format = PlyFormat::Ascii;
      else if (format == "binary_little_endian")
        header.format = PlyFormat::LittleEndian;
      else if (format == "binary_big_endian")
        header.format = PlyFormat::BigEndian;
      else
        throw error(fmt::format("unknown format '{}'", shown(format)));
      has_format = true;
    } else if (keyword == "element") {
      PlyElement element;
      element.name = take_word(line);
      const auto count = to_number<uint64_t>(take_word(line));
      if (element.name.empty() || !count) throw error("an element needs a name and a count");
      element.count = *count;
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) throw error("a property before the first element");
      PlyProperty property;
      std::string_view type = take_word(line);
      if (type == "list") {
        const auto count_type = type_named(take_word(line));
        if (!count_type || *count_type >= PlyType::Float32)
          throw error("a list whose length is not an integer");
        property.is_list = true, property.count_type = *count_type;
        type = take_word(line);
      }
      const auto known = type_named(type);
      if (!known) throw error(fmt::format("unknown type '{}'", shown(type)));
      property.type = *known, property.name = take_word(line);
      header.elements.back().properties.push_back(std::move(property));
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      throw error(fmt::format("'{}' is not part of a PLY header", shown(keyword)));
    }
  }
  throw error("the header does not end");
}

}  // namespace liana
