// A plant as a skeleton: points joined in a tree, each with a radius.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

struct GraphNode {
  Vec3 position;    ///< m, +Y up
  int parent = -1;  ///< index of a node before this one; -1 where a trunk begins
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< m; NaN: unknown
  bool begins_axis = false;  ///< a new branch starts between the parent and this node
};

struct PlantGraph {
  std::vector<GraphNode> nodes;
  std::vector<std::string> notes;  ///< what was passed over or assumed
};

constexpr double kTipRadius = 0.0015;  ///< m, of tips when no radius at all is known

/// Gives every node without a radius one: along an axis between two known ones in proportion; towards tips
/// and bases, and where nothing is known, by the pipe model (a section is as large as those it carries
/// [Shinozaki 1964]), from tips of the smallest known radius or kTipRadius, never thicker than what carries
/// it. Returns how many.
size_t fill_radii(PlantGraph& graph);

}  // namespace liana
