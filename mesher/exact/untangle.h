// Self-intersections taken out of a closed surface, by CGAL.
#pragma once

#include <optional>

#include "mesher/geometry/mesh.h"

namespace liana {

/// The surface with the places where it passes through itself cut out and filled anew; the rest keeps its
/// vertices. The input is a closed oriented manifold. Nothing if some crossing remains, or CGAL gives up.
std::optional<Mesh> untangled(const Mesh& closed);

}  // namespace liana
