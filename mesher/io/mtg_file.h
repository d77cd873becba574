// Multiscale tree graphs (.mtg), the format of OpenAlea for plant architecture.
#pragma once

#include <string>
#include <string_view>

#include "mesher/plant/plant_graph.h"

namespace liana {

/// The digitised skeleton in an MTG: entities with XX, YY, ZZ (or X, Y, Z) become nodes in the file's unit
/// and axes, with half of TopDia (or Diameter; millimetres) as radius in metres. Entities without a position
/// only link others. Edges: / decomposes, < continues an axis, + begins one; ^ refers to the same column's
/// last entity, else the column before. Throws Error{Input} naming the line. The format: Godin, Costes,
/// Caraglio 1997.
PlantGraph parse_mtg(std::string_view bytes, const std::string& file);

}  // namespace liana
