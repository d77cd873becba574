// A welded skin (one closed surface around a whole branching structure) cut into one solid for each axis.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

struct SkinPiece {
  Mesh surface;  ///< closed, oriented outward, without the vertices of other pieces
  int parent;    ///< index of the piece it was cut from; -1: the root piece, which is the first
  /// Of the root piece: what mending the skin has cost, shares of its area and volume.
  double lost_area = 0, lost_volume = 0;
};

/// True if a surface is a tube with side branches: cut_skin() would return more than one piece. Open ends
/// count as closed by lids, small damage is mended (mend.h); false if no oriented manifold in one part
/// remains, or if more than 2 % of the surface would be lost by it.
bool is_branching_skin(const Mesh& shell);

/// Cuts a skin along the tree of its geodesic level sets (branch_axes.h) with one plane a branch, where the
/// branch has just left its parent. At a fork the thickest and straightest child carries the axis on. Every
/// cut is closed with the same lid on both sides, so that the volumes of the pieces add up to that of the
/// skin. Pieces come parents first. A branch for which no cut leaves two solids stays with its parent; a skin
/// that is not branching comes back as one piece. Cost: a few geodesic sweeps, n log n.
std::vector<SkinPiece> cut_skin(const Mesh& shell);

}  // namespace liana
