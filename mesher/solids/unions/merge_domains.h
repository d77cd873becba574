// Coarse decompositions: [Wang17] §7, Figure 18.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/progress.h"
#include "mesher/plant/segmented_plant.h"

namespace liana {

struct MergedPlant {
  SegmentedPlant plant;          ///< its notes also say how many became one, and by name what could not
  std::vector<DomainId> became;  ///< per domain before: the one it is now, or is a part of
};

/// Every branch of `level` and all branches that grow on it become one domain: the union of their solids, so
/// that its modes are those of the branch with its twigs. Leaves stay leaves ([Wang17] §4.3 gives them a law
/// of their own) and hang on what their twig became. A branch that shares no volume with what it grows on,
/// or whose union with it has no valid surface, stays a domain of its own. threads 0: one a core. Throws
/// Error{Cancelled}.
MergedPlant merge_below(const SegmentedPlant& plant, int level, unsigned threads, Progress& progress);

}  // namespace liana
