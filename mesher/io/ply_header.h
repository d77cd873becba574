// The header of a PLY file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace liana {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType : uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

size_t size_of(PlyType type);  ///< bytes

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;  ///< of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::Uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  size_t count = 0;
  std::vector<PlyProperty> properties;

  int find(std::string_view property) const;   ///< -1 when there is none
  size_t least_bytes(PlyFormat format) const;  ///< that one of it takes in the file
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  size_t bytes = 0;  ///< length of the header
  size_t lines = 0;
};

/// Throws Error{Input} naming file and line.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

}  // namespace liana
