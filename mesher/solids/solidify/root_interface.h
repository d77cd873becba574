// Which part of a domain its parent (the ground, for a trunk) holds.
#pragma once

#include <vector>

#include "mesher/geometry/mesh_checks.h"
#include "mesher/solids/solidify/parent_surface.h"

namespace liana {

/// The border loop at the root of an open body, or loops.size() if the root end is closed.
size_t root_loop(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops,
                 const ParentSurface& support);

/// Marks the end of a closed, outward body that is nearest to its support: the faces around the point
/// farthest from the other end that look away from it, up to the first crease.
std::vector<uint8_t> root_end(const Mesh& mesh, const Adjacency& adjacency, const ParentSurface& support);

/// The root of a sheet.
struct SheetRoot {
  std::vector<std::vector<uint8_t>> edges;  ///< in the order of the loops: border edges that are held
  uint32_t point = Id<Mesh>::kNone;         ///< the vertex a pointed base ends in; then no edge is marked
  double strip = 0;                         ///< m: what is nearer to the point is held
};

/// The base of a sheet is the end of its long axis that is nearest to the support: the edges across it
/// within 4 % of the sheet's length, or a point.
SheetRoot sheet_root(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops,
                     const ParentSurface& support);

}  // namespace liana
