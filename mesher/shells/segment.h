// A merged mesh becomes a segmented plant.
#pragma once

#include "mesher/io/triangle_soup.h"
#include "mesher/shells/load_plant.h"

namespace liana {

/// Splits the soup (+Y up, in its own unit) into shells, tells branches from leaves, finds the hierarchy, the
/// unit if it is Auto, and names the domains. `file` names it in messages. Throws Error{Input} when there is
/// no branch.
SegmentedPlant segment(const TriangleSoup& soup, Unit unit, const std::string& file);

}  // namespace liana
