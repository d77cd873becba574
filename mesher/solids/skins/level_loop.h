// One closed level line of a value given at the vertices, found by walking from triangle to triangle.
#pragma once

#include <functional>
#include <optional>

#include "mesher/geometry/mesh_checks.h"

namespace liana {

/// Where a level line crosses a mesh edge, from a vertex below to one at or above zero.
struct EdgeCrossing {
  uint32_t below, above;
  uint32_t triangle;  ///< one of the two at the edge: the one the line goes on through
  Vec3 point;         ///< m, where the value is zero
};

/// Closed; the points are the polygon.
using LevelLoop = std::vector<EdgeCrossing>;

using VertexValue = std::function<double(uint32_t)>;

/// The level line value = 0 through the edge (below, above) of an oriented manifold, or nothing if it meets
/// the border or has fewer than three crossings. value(below) < 0 <= value(above); `triangle` is at the edge.
std::optional<LevelLoop> trace_loop(const Mesh& mesh, const Adjacency& adjacency, const VertexValue& value,
                                    uint32_t below, uint32_t above, uint32_t triangle);

std::vector<Vec3> polygon_of(const LevelLoop& loop);
double perimeter(const LevelLoop& loop);  ///< m

}  // namespace liana
