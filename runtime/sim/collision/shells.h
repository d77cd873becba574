// A real-world mesh as what contacts can work with: solids, and sheets for what has no inside.
#pragma once

#include <memory>
#include <vector>

#include "runtime/sim/collision/sdf_obstacle.h"

namespace liana {

struct ShellOptions {
  double thickness = 4e-3;  ///< m, of a sheet
  size_t most_solids = 64;  ///< closed shells beyond that, the smallest, count as sheets
  ContactFeel feel = {};
};

struct Shells {
  std::vector<std::unique_ptr<SdfObstacle>> obstacles;
  size_t solids = 0;  ///< closed shells that are solid
  size_t sheets = 0;  ///< connected pieces that count as sheets
};

/// Splits a mesh into its connected pieces: closed ones that look outwards become one solid each, all others
/// together one obstacle of sheets. Throws Error{Input} for an empty or non-finite mesh.
Shells obstacles_from(const Mesh& mesh, const ShellOptions& options = {});

}  // namespace liana
