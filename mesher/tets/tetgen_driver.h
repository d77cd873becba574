// TetGen 1.5 as a re-entrant function. Nothing here checks the input: tetrahedralize() does.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesher/tets/tetrahedralize.h"

namespace liana {

struct BoundaryFace {
  std::array<uint32_t, 3> corners;
  bool is_root;
};

struct TetGenResult {
  std::vector<Vec3> positions;                ///< the input's vertices in their order, then the inserted ones
  std::vector<std::array<uint32_t, 4>> tets;  ///< orientation as TetGen gives it
  std::vector<BoundaryFace> boundary;
  std::string failure;  ///< why it gave up; empty if it did not
};

/// How hard TetGen works on badly shaped tets.
enum class Polish {
  Flips,   ///< only reconnects
  Points,  ///< also inserts and moves points, to TetOptions' bounds: no slivers remain, ten times slower
};

/// Extents of the input must not exceed 1 along any axis. The same input gives the same result on any thread.
TetGenResult run_tetgen(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                        std::span<const uint8_t> is_root, const TetOptions& options, Polish polish);

}  // namespace liana
