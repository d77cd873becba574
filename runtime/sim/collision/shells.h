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

/// A mesh as what has an inside and what has not.
struct Pieces {
  std::vector<Mesh> solids;  ///< closed, outward, connected
  Mesh sheets;               ///< all others
  size_t sheet_count = 0;    ///< connected pieces of those
};

/// Splits a mesh into its connected pieces. Throws Error{Input} for an empty or non-finite mesh.
Pieces pieces_of(const Mesh& mesh, size_t most_solids = ShellOptions().most_solids);

struct Shells {
  std::vector<std::unique_ptr<SdfObstacle>> obstacles;
  size_t solids = 0;  ///< closed shells that are solid
  size_t sheets = 0;  ///< connected pieces that count as sheets
};

/// Solids become one obstacle each, sheets all together one. Throws as pieces_of().
Shells obstacles_from(const Mesh& mesh, const ShellOptions& options = {});

}  // namespace liana
