// A skeleton becomes branches with surfaces.
#pragma once

#include "mesher/plant/plant_graph.h"
#include "mesher/plant/segmented_plant.h"

namespace liana {

/// Every axis of the graph becomes one tube of `sides` sides, open at its root and closed at its tip, that
/// begins on its parent's middle line. An axis goes on from a node to the child that does not begin one: of
/// several the thickest, then the straightest. Points that stand too close for a ring of their own (nearer
/// than half a radius, or so that rings would cross in a bend) are left out; axes without length are dropped,
/// and what grows from them grows from their parents. The graph is in metres, +Y up, with all radii known.
/// Throws Error{Input} starting with `file` when no axis has a length.
SegmentedPlant branch_tubes(const PlantGraph& graph, const std::string& file, int sides = 8);

}  // namespace liana
