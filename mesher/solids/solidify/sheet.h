// Leaves are modelled as sheets; a solid leaf is the sheet with its thickness.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// True if an open surface is a sheet rather than a body with holes: lids on its border loops would be about
/// as large as the surface itself, while the lids of a tube are small.
bool is_sheet(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops);

/// Both sides of an oriented sheet half a thickness away, joined along the border. Offsets are mitred so that
/// the volume is area times thickness up to the third power of the thickness over the radius of bending. With
/// n vertices and m triangles in the sheet: v and v + n are the two sides of vertex v, triangles i and i + m
/// those of triangle i; then come two triangles for every border edge in the order of the loops.
Mesh extrude_sheet(const Mesh& sheet, const std::vector<std::vector<uint32_t>>& loops, double thickness);

}  // namespace liana
