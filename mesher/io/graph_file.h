// Our own plant graph as JSON.
#pragma once

#include <string>
#include <string_view>

#include "mesher/plant/plant_graph.h"

namespace liana {

/// {"liana_graph": 1, "nodes": [{"parent": null or index of an earlier node, "position": [x, y, z], "radius":
/// r, "begins_axis": true}, ...]}; radius and begins_axis may be left out. Positions and radii in the file's
/// unit. Throws Error{Input} naming the node.
PlantGraph parse_graph(std::string_view bytes, const std::string& file);

std::string graph_text(const PlantGraph& graph);  ///< what parse_graph reads; unknown radii are left out

}  // namespace liana
