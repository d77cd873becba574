// Surfaces as downloaded files have them: torn, doubled, tangled.
#pragma once

#include <random>

#include "tests/support/solids/shapes.h"

namespace liana {

/// Puts a vertex in the middle of a triangle's edge on one side only: a T-junction of length `gap` (m).
void split_one_side(Mesh& mesh, size_t triangle, double gap = 0);

/// A triangle standing out from the first edge of `triangle` by `height` (m).
void add_fin(Mesh& mesh, size_t triangle, double height);

/// A wall across a tube of `sides` sides through the vertices of its ring `ring`.
void add_septum(Mesh& mesh, int sides, int ring);

/// `count` closed prisms along +y, each reaching `overlap` (m) into the one before: a stem of separate
/// solids.
Mesh stem_of_pieces(int sides, double length, double diameter, int count, double overlap);

/// One random harm of a kind that files have: a lost, flipped or doubled triangle, a moved, merged or doubled
/// vertex, a wrong index, a second crossing part.
void harm(Mesh& mesh, std::mt19937& random);

}  // namespace liana
