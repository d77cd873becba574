// parse_ply: the elements one after the other, each value through one of two readers.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "mesher/base/error.h"
#include "mesher/base/memory.h"
#include "mesher/geometry/polygon.h"
#include "mesher/io/ply_header.h"
#include "mesher/io/text_cursor.h"
#include "mesher/io/triangle_soup.h"

namespace liana {
namespace {

static_assert(std::endian::native == std::endian::little);

const char* const kExportAgain = "the file is cut short or damaged: export the mesh again";

/// The values of the body in their order; ASCII words may stand on any line.
class PlyValues {
 public:
  PlyValues(std::string_view body, PlyFormat format) : body_(body), rest_(body), format_(format) {}

  /// NaN where the body ends or holds no number.
  double next(PlyType type) { return format_ == PlyFormat::Ascii ? next_word() : next_binary(type); }
  size_t bytes_left() const { return rest_.size(); }
  bool is_ascii() const { return format_ == PlyFormat::Ascii; }
  /// Ends of lines before the end of the value last given.
  size_t lines_passed() const {
    const std::string_view passed = body_.substr(0, body_.size() - rest_.size());
    return static_cast<size_t>(std::count(passed.begin(), passed.end(), '\n'));
  }

 private:
  double next_word() {
    const size_t first = rest_.find_first_not_of(" \t\v\f\r\n");
    if (first == std::string_view::npos) return rest_ = {}, NAN;
    const size_t end = std::min(rest_.find_first_of(" \t\v\f\r\n", first), rest_.size());
    const std::optional<double> number = to_number<double>(rest_.substr(first, end - first));
    rest_.remove_prefix(end);
    return number.value_or(NAN);
  }

  template <class Value>
  static double as(const char* bytes) {
    Value value;
    std::memcpy(&value, bytes, sizeof(value));
    return static_cast<double>(value);
  }

  double next_binary(PlyType type) {
    const size_t size = size_of(type);
    if (rest_.size() < size) return rest_ = {}, NAN;
    char bytes[8];
    std::memcpy(bytes, rest_.data(), size);
    rest_.remove_prefix(size);
    if (format_ == PlyFormat::BigEndian) std::reverse(bytes, bytes + size);
    switch (type) {
      case PlyType::Int8:
        return as<int8_t>(bytes);
      case PlyType::Uint8:
        return as<uint8_t>(bytes);
      case PlyType::Int16:
        return as<int16_t>(bytes);
      case PlyType::Uint16:
        return as<uint16_t>(bytes);
      case PlyType::Int32:
        return as<int32_t>(bytes);
      case PlyType::Uint32:
        return as<uint32_t>(bytes);
      case PlyType::Float32:
        return as<float>(bytes);
      default:
        return as<double>(bytes);
    }
  }

  std::string_view body_, rest_;
  PlyFormat format_;
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& file)
      : file_(file),
        header_(parse_ply_header(bytes, file)),
        values_(bytes.substr(header_.bytes), header_.format) {}

  TriangleSoup parse() {
    for (const PlyElement& element : header_.elements) {
      const size_t least = element.least_bytes(header_.format);
      if (element.count > 0 && least > 0 && element.count > values_.bytes_left() / least)
        throw error_here(fmt::format("{} elements '{}' do not fit into the {} bytes that are left",
                                     element.count, shown(element.name), values_.bytes_left()));
      if (element.name == "vertex")
        vertices(element);
      else if (element.name == "face")
        faces(element);
      else
        pass_over(element);
    }
    finish();
    return std::move(soup_);
  }

 private:
  Error error(const std::string& reason, const std::string& hint = kExportAgain) const {
    return Error(Error::Kind::Input, file_ + ": " + reason, hint);
  }
  /// With the line of the value last read, if there are lines.
  Error error_here(const std::string& reason) const {
    if (!values_.is_ascii()) return error(reason);
    return Error(Error::Kind::Input,
                 fmt::format("{}:{}: {}", file_, header_.lines + 1 + values_.lines_passed(), reason),
                 kExportAgain);
  }

  size_t list_length(const PlyProperty& property, const PlyElement& element, size_t index) {
    const double length = values_.next(property.count_type);
    const size_t least = values_.is_ascii() ? 1 : size_of(property.type);
    if (!(length >= 0) || length > double(values_.bytes_left() / least) || length != std::floor(length))
      throw error_here(fmt::format("the list '{}' of {} {} has a length that the file cannot hold",
                                   shown(property.name), shown(element.name), index));
    return static_cast<size_t>(length);
  }

  void skip(const PlyProperty& property, const PlyElement& element, size_t index) {
    const size_t count = property.is_list ? list_length(property, element, index) : 1;
    for (size_t i = 0; i < count; ++i) values_.next(property.type);
  }

  void pass_over(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) skip(property, element, i);
    if (element.count)
      soup_.notes.push_back(fmt::format("{} elements '{}' passed over", element.count, shown(element.name)));
  }

  void vertices(const PlyElement& element) {
    const int axes[3] = {element.find("x"), element.find("y"), element.find("z")};
    for (const int axis : axes)
      if (axis < 0 || element.properties[axis].is_list)
        throw error("its vertices have no x, y and z", "export it again");
    soup_.positions.reserve(element.count);
    for (size_t i = 0; i < element.count; ++i) {
      Vec3 position;
      for (size_t p = 0; p < element.properties.size(); ++p) {
        const auto axis = std::find(axes, axes + 3, static_cast<int>(p)) - axes;
        if (axis == 3)
          skip(element.properties[p], element, i);
        else
          position[axis] = values_.next(element.properties[p].type);
      }
      if (!position.allFinite()) throw error_here(fmt::format("vertex {} has no finite position", i));
      soup_.positions.push_back(position);
    }
  }

  void faces(const PlyElement& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || !element.properties[list].is_list) throw error("its faces have no list 'vertex_indices'");
    soup_.triangles.reserve(std::min(element.count, kMaxSoupTriangles));
    for (size_t i = 0; i < element.count; ++i)
      for (size_t p = 0; p < element.properties.size(); ++p) {
        if (static_cast<int>(p) == list)
          face(element.properties[p], element, i);
        else
          skip(element.properties[p], element, i);
      }
  }

  void face(const PlyProperty& property, const PlyElement& element, size_t index) {
    corners_.resize(list_length(property, element, index));
    for (uint32_t& corner : corners_) {
      const double vertex = values_.next(property.type);
      if (!(vertex >= 0) || vertex >= double(soup_.positions.size()) || vertex != std::floor(vertex))
        throw error_here(
            fmt::format("face {} names vertex {}, and there are {}", index, vertex, soup_.positions.size()));
      corner = static_cast<uint32_t>(vertex);
    }
    if (corners_.size() < 3) {
      ++without_area_;
      return;
    }
    append_polygon(corners_, soup_.positions, soup_.triangles);
    if (soup_.triangles.size() > kMaxSoupTriangles)
      throw error(fmt::format("more than {} triangles", kMaxSoupTriangles), "simplify the plant");
  }

  void finish() {
    if (soup_.triangles.empty())
      throw error(fmt::format("holds no faces ({} points)", soup_.positions.size()),
                  "a point cloud must be made a surface first, in MeshLab or CloudCompare for instance");
    if (without_area_)
      soup_.notes.push_back(fmt::format("{} faces of fewer than three corners passed over", without_area_));
    soup_.labels.resize(1);
    soup_.label.assign(soup_.triangles.size(), 0);
  }

  const std::string& file_;
  PlyHeader header_;
  PlyValues values_;
  TriangleSoup soup_;
  std::vector<uint32_t> corners_;
  size_t without_area_ = 0;
};

}  // namespace

TriangleSoup parse_ply(std::string_view bytes, const std::string& file) {
  require_memory(4 * bytes.size(),
                 file + ": reading it");  // 24 B a position from >= 12, 12 B a triangle from >= 13
  return PlyParser(bytes, file).parse();
}

}  // namespace liana
