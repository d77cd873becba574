// parse_obj: line by line, as files in the wild are.
#include <fmt/core.h>

#include <cmath>
#include <unordered_map>

#include "mesher/base/error.h"
#include "mesher/base/memory.h"
#include "mesher/geometry/polygon.h"
#include "mesher/io/text_cursor.h"
#include "mesher/io/triangle_soup.h"

namespace liana {
namespace {

class ObjParser {
 public:
  explicit ObjParser(std::string_view bytes, const std::string& file) : lines_(bytes), file_(file) {}

  TriangleSoup parse() {
    std::string_view line;
    std::string joined;
    while (lines_.next(line)) {
      if (!line.empty() && line.back() == '\\') {  // goes on in the next line
        joined.clear();
        while (!line.empty() && line.back() == '\\') {
          joined.append(line.substr(0, line.size() - 1)).push_back(' ');
          if (!lines_.next(line)) line = {};
        }
        line = joined.append(line);
      }
      statement(line);
    }
    finish();
    return std::move(soup_);
  }

 private:
  Error error(const std::string& reason, const std::string& hint, size_t line = 0) const {
    return Error(Error::Kind::Input, fmt::format("{}:{}: {}", file_, line ? line : lines_.number(), reason),
                 hint);
  }

  void statement(std::string_view line) {
    const std::string_view keyword = take_word(line);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") {
      vertex(line);
    } else if (keyword == "f" || keyword == "fo") {
      face(line);
    } else if (keyword == "o" || keyword == "g") {
      (keyword == "o" ? object_ : group_) = without_outer_blanks(line);
      label_known_ = false;
    } else if (keyword == "usemtl") {
      material_ = without_outer_blanks(line);
      label_known_ = false;
    } else if (keyword == "l" || keyword == "p") {
      ++lines_and_points_;
    } else if (keyword != "vn" && keyword != "vt" && keyword != "s" && keyword != "mtllib" &&
               keyword != "vp") {
      if (unknown_++ == 0) first_unknown_ = fmt::format("line {}: '{}'", lines_.number(), shown(keyword));
    }
  }

  void vertex(std::string_view line) {
    Vec3 position;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = take_word(line);
      const std::optional<double> number = to_number<double>(word);
      if (!number || !std::isfinite(*number))
        throw error(word.empty() ? "a vertex has fewer than three coordinates"
                                 : fmt::format("'{}' is not a coordinate", shown(word)),
                    "a vertex line reads: v X Y Z, with a point as decimal separator; export the mesh again");
      position[k] = *number;
    }
    soup_.positions.push_back(position);
  }

  void face(std::string_view line) {
    corners_.clear();
    bool known = true;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const std::optional<int64_t> index = to_number<int64_t>(word.substr(0, word.find('/')));
      const auto count = static_cast<int64_t>(soup_.positions.size());
      if (!index || *index == 0 || *index < -count || *index > int64_t{4'000'000'000})
        throw error(fmt::format("a face names vertex '{}', and {} are known", shown(word), count),
                    "vertices are numbered from 1, or from -1 backwards; export the mesh again");
      corners_.push_back(static_cast<uint32_t>(*index > 0 ? *index - 1 : count + *index));
      if (*index > count) {
        known = false;
        if (*index > last_named_) last_named_ = *index, last_named_at_ = lines_.number();
      }
    }
    if (corners_.size() < 3) {
      ++lines_and_points_;
      return;
    }
    if (known)
      append_polygon(corners_, soup_.positions, soup_.triangles);
    else  // of vertices that come later nothing but their number is known yet
      for (size_t i = 2; i < corners_.size(); ++i)
        soup_.triangles.push_back({corners_[0], corners_[i - 1], corners_[i]});
    if (soup_.triangles.size() > kMaxSoupTriangles)
      throw error(fmt::format("more than {} triangles", kMaxSoupTriangles), "simplify the plant");
    soup_.label.resize(soup_.triangles.size(), label());
  }

  uint32_t label() {
    if (!label_known_) {
      const std::string& object = object_.empty() ? group_ : object_;
      const auto [place, is_new] = labels_.try_emplace(object + '\n' + material_, soup_.labels.size());
      if (is_new) soup_.labels.push_back({object, material_});
      label_ = place->second, label_known_ = true;
    }
    return label_;
  }

  void finish() {
    if (last_named_ > static_cast<int64_t>(soup_.positions.size()))
      throw error(
          fmt::format("a face names vertex {}, and the file has {}", last_named_, soup_.positions.size()),
          "the file is cut short or damaged: export the mesh again", last_named_at_);
    if (soup_.triangles.empty())
      throw Error(Error::Kind::Input,
                  fmt::format("{}: holds no faces ({} vertices, {} lines or points)", file_,
                              soup_.positions.size(), lines_and_points_),
                  "give a surface mesh; curves must be converted to a mesh, with a bevel, before exporting");
    if (lines_and_points_)
      soup_.notes.push_back(
          fmt::format("{} lines, points or faces of two corners passed over", lines_and_points_));
    if (unknown_)
      soup_.notes.push_back(fmt::format("{} statements that are not of a mesh passed over (first, {})",
                                        unknown_, first_unknown_));
  }

  LineCursor lines_;
  const std::string& file_;
  TriangleSoup soup_;
  std::unordered_map<std::string, uint32_t> labels_;
  std::string object_, group_, material_, first_unknown_;
  uint32_t label_ = 0;
  bool label_known_ = false;
  std::vector<uint32_t> corners_;
  int64_t last_named_ = 0;
  size_t last_named_at_ = 0, lines_and_points_ = 0, unknown_ = 0;
};

}  // namespace

TriangleSoup parse_obj(std::string_view bytes, const std::string& file) {
  require_memory(3 * bytes.size(),
                 file + ": reading it");  // 24 B a position from >= 12, 16 B a triangle from >= 8
  return ObjParser(bytes, file).parse();
}

}  // namespace liana
