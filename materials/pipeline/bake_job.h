// What every step of a bake reads and none changes.
#pragma once

#include "materials/pipeline/bake_plant.h"

namespace liana {

struct BakeJob {
  const SegmentedPlant& plant;
  const SpeciesLaw& species;
  const std::vector<std::string>& groups;  ///< of the species, per domain
  const BakeOptions& options;
  Progress& progress;
};

/// The group of each domain. Throws Error{Input} when the plant is empty, the law is out of range or has no
/// group for a domain.
std::vector<std::string> groups_of(const SegmentedPlant& plant, const SpeciesLaw& species);

}  // namespace liana
