// Unstructured meshes with fields for ParaView and meshio: VTK's XML format, base64 inline.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

struct VtuField {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< components each
};

/// Cells of one kind: straight quadratic tetrahedra, corners first, then the nodes on edges 01, 12, 02, 03,
/// 13, 23.
struct VtuMesh {
  std::vector<Vec3> points;            ///< m
  std::vector<uint32_t> cells;         ///< 10 each
  std::vector<VtuField> point_fields;  ///< values for every point
  std::vector<VtuField> cell_fields;   ///< values for every cell
  std::vector<VtuField> numbers;       ///< of the whole file
};

/// Written whole or not at all. Throws Error{Output}.
void write_vtu(const VtuMesh& mesh, const std::filesystem::path& path);

}  // namespace liana
