// Triangles as a file lists them, before anything is known of branches and leaves.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// What the file calls the triangles it lists; either may be empty.
struct SoupLabel {
  std::string object, material;
};

struct TriangleSoup {
  std::vector<Vec3> positions;      ///< in the file's unit and axes, finite
  std::vector<Triangle> triangles;  ///< valid indices; corners may coincide
  std::vector<uint32_t> label;      ///< per triangle, index into labels
  std::vector<SoupLabel> labels;    ///< at least one if there are triangles
  std::vector<std::string> notes;   ///< what was passed over
};

constexpr size_t kMaxSoupTriangles = 50'000'000;

/// Wavefront OBJ: polygons, negative and forward indices, CRLF, continued lines, any numbers after the third
/// of a vertex. Normals, texture coordinates, lines and points are passed over. `file` names it in messages.
/// Throws Error{Input} with the line.
TriangleSoup parse_obj(std::string_view bytes, const std::string& file);

/// Stanford PLY: ASCII, binary little and big endian, any property types, other elements passed over. Throws
/// Error{Input} with the line or the element.
TriangleSoup parse_ply(std::string_view bytes, const std::string& file);

}  // namespace liana
