// What each material model makes of one bake's domains: [Wang17] Figures 15 and 16 as numbers.
#pragma once

#include <array>
#include <string>

#include "materials/bake/bake.h"
#include "materials/law/material_model.h"

namespace liana {

struct ModelComparison {
  std::array<ModelFrequencies, std::size(kMaterialModels)> models;  ///< in the order of kMaterialModels
};

/// Exactly what baking by each of the models gives: they share the modes, which the bake has.
ModelComparison compare_models(const Bake& bake);

/// One line a domain, with units in the header: where it is, ℓ, ν_default, and ν, E and ξ by each model.
std::string comparison_csv(const Bake& bake, const ModelComparison& comparison);

}  // namespace liana
