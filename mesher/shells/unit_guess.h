// In which unit a plant was modelled.
#pragma once

#include <string>

#include "mesher/shells/load_plant.h"

namespace liana {

/// What a plant's sizes are, in units of its file; 0 where there is none.
struct PlantSizes {
  double height = 0;       ///< largest extent
  double leaf_length = 0;  ///< median
  double thin_branch = 0;  ///< diameter that a tenth of the branches is below
};

struct UnitGuess {
  Unit unit = Unit::Metre;
  std::string reason;  ///< for people
  double doubt = 0;    ///< likelihood of the next best unit over that of this one, 0 to 1
};

double metres(Unit unit);             ///< per unit; not for Auto
std::string_view name_of(Unit unit);  ///< "metres", ...

/// The unit in which the sizes are least unusual for a plant: height 3 m, leaf 7 cm, thin branch 5 mm, each
/// with a spread of its logarithm.
UnitGuess guess_unit(const PlantSizes& sizes);

}  // namespace liana
