// A real-world mesh as what contacts can work with: solids, and sheets for what has no inside.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

constexpr double kSheetThickness = 4e-3;  ///< m, unless somebody says otherwise

struct Pieces {
  std::vector<Mesh> solids;  ///< closed, outward, connected; the 64 largest of them
  Mesh sheets;               ///< all others
  size_t sheet_count = 0;    ///< connected pieces of those
};

/// Splits a mesh into its connected pieces. Throws Error{Input} for an empty or non-finite mesh.
Pieces pieces_of(const Mesh& mesh);

}  // namespace liana
