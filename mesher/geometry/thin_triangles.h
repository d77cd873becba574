// Needles and caps taken out of a closed surface: where surfaces were cut by one another, triangles are as
// thin as chance has it.
#pragma once

#include "mesher/geometry/mesh.h"

namespace liana {

/// Collapses edges shorter than `least` and takes out triangles lower than that (m): needles by collapsing
/// their short edge, caps by flipping their long one. No triangle is turned over by it, and the topology
/// stays; what cannot be done under these conditions is left. The surface moves by `least` at most in one
/// step. Closed, oriented, without flat edges of three triangles.
Mesh without_thin_triangles(const Mesh& closed, double least);

}  // namespace liana
