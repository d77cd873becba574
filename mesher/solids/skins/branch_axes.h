// The branching of one closed surface: which tips it has and where their axes leave one another.
#pragma once

#include <vector>

#include "mesher/solids/skins/level_loop.h"

namespace liana {

/// A surface with all that its branching is read from.
///
/// The superlevel sets {f > c} of the distance f from the root grow together as c falls: each begins at a
/// local maximum (a tip) and joins another at a saddle (a crotch). This merge tree (Carr et al. 2003: the
/// join tree) is the surface's branching, at every scale at once; a tip counts if it stands farther above its
/// saddle than the branch is thick there.
struct SkinField {
  Mesh mesh;  ///< closed, oriented, one part
  Adjacency adjacency;
  std::vector<double> distance;  ///< f, m, per vertex
  VertexTriangles around;
  uint32_t root = 0;                      ///< a vertex on the root end
  double lost_area = 0, lost_volume = 0;  ///< shares that mending has cost

  /// A triangle with the edge (a, b) in either direction; kNone if there is none.
  uint32_t triangle_at_edge(uint32_t a, uint32_t b) const;
};

/// A tip and the way down to where it joins another axis.
struct BranchAxis {
  uint32_t tip = 0;
  uint32_t crotch = 0;  ///< vertex of the saddle; unused for the trunk
  double base = 0;      ///< f at the saddle, m; 0 for the trunk
  double diameter = 0;  ///< m, of the circle with the level line's perimeter just above the saddle
  int parent = -1;      ///< the axis it joins
};

/// Mends and closes the surface, turns it outward and measures distances from its lowest end. False if no
/// oriented manifold in one part comes out.
bool make_skin_field(const Mesh& shell, SkinField& field);

/// All axes; the trunk first, parents before children.
std::vector<BranchAxis> find_branch_axes(const SkinField& field);

/// Vertices from a tip down to the root, each lower than the one before.
std::vector<uint32_t> way_down(const SkinField& field, uint32_t from);

/// The level line value = 0 around the axis, through the lowest edge of `way` (as way_down gives it) that
/// crosses it with f above `base`.
std::optional<LevelLoop> loop_across(const SkinField& field, const std::vector<uint32_t>& way, double base,
                                     const VertexValue& value);

}  // namespace liana
