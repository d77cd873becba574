// Lids on open tubes.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Area of the fan of triangles from the middle of a border loop to its edges, m².
double lid_area(const Mesh& mesh, const std::vector<uint32_t>& loop);

Vec3 loop_middle(const Mesh& mesh, const std::vector<uint32_t>& loop);  ///< weighted by edge length

/// Closes a border loop (as border_loops gives it): one triangle for three edges, else a fan around a new
/// vertex in its middle. The new triangles are wound like their neighbours and come last. Returns how many
/// there are.
size_t add_lid(Mesh& mesh, const std::vector<uint32_t>& loop);

}  // namespace liana
