// Which part of a domain its parent (the ground, for a trunk) holds.
#pragma once

#include <vector>

#include "mesher/base/mesh_checks.h"
#include "mesher/surface/attachment.h"

namespace liana {

/// The border loop at the root of an open body, or loops.size() if the root end is closed.
size_t root_loop(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops,
                 const Attachment& attachment);

/// Marks the end of a closed, outward body that is nearest to its attachment: the faces around the point
/// farthest from the other end that look away from it, up to the first crease.
std::vector<uint8_t> root_end(const Mesh& mesh, const Adjacency& adjacency, const Attachment& attachment);

/// Marks, in the order of the loops, the border edges of a sheet that are its root: the strip nearest the
/// attachment, within 4 % of the sheet's length; at a pointed base the two edges at the point.
std::vector<std::vector<uint8_t>> root_edges(const Mesh& mesh,
                                             const std::vector<std::vector<uint32_t>>& loops,
                                             const Attachment& attachment);

}  // namespace liana
