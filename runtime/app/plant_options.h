// The options of every verb that reads a plant.
#pragma once

#include "mesher/shells/load_plant.h"

namespace CLI {
class App;
}

namespace liana {

/// Adds --unit, --up and --merged to a verb; they are written into `options`, which must outlive the parsing.
void add_plant_options(CLI::App& verb, LoadOptions& options);

}  // namespace liana
