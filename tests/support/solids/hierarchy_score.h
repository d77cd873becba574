// How much of a plant's true hierarchy was found again.
#pragma once

#include <string>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

struct HierarchyScore {
  size_t domains = 0;  ///< of the truth
  size_t found = 0;    ///< a domain of the same kind with the same surface, by its middle and its area
  size_t right = 0;    ///< found, with the true parent
  std::vector<std::string> wrong;  ///< the first few, for people
};

HierarchyScore score(const SegmentedPlant& truth, const SegmentedPlant& found);

/// The plant as one mesh with shared vertices per domain, as an exporter that joins all objects writes it.
std::string merged_obj(const SegmentedPlant& plant, bool materials, double scale = 1);

}  // namespace liana
