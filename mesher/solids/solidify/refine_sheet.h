// A sheet's triangles made small enough to bend: cards of one or two quadrangles are too stiff.
#pragma once

#include "mesher/solids/solidify/line_cut.h"

namespace liana {

/// Bisects edges, the longest first, until all are short against length / 8 along the distance and
/// width / 4 across it (width: area / length) or shorter than `least` (m). Bisecting the longest edges ends
/// in squares with both diagonals, where T10 tets of a thin plate can bend without shear (continuously
/// differentiable quadratics exist on them): a cantilevered card is 1.5 % too stiff, where one diagonal a
/// square makes 3 %. The shape does not change, and equal shapes in other places are cut alike. Returns the
/// number of edges bisected.
int refine_sheet(MarkedSurface& surface, double length, double least);

}  // namespace liana
