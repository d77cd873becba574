// What a bake found, as JSON for other programs. The keys are stable.
#pragma once

#include <string>

#include "materials/pipeline/bake_plant.h"

namespace liana {

/// {"plant","species","seconds":{...},"domains":[{"id","name","parent",...}], "failed","notes","plant_hash",
/// "species_hash"}; parent is null for a trunk, solved_as the id of the domain whose modes were shared.
std::string bake_report(const BakeResult& result);

}  // namespace liana
