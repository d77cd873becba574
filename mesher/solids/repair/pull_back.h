// A wrap moved onto what it wraps.
#pragma once

#include "mesher/geometry/mesh.h"

namespace liana {

/// Every vertex of `wrap` within `reach` (m) of the triangles goes to the nearest point on them: the wrap's
/// offset, which would thicken a branch and raise its frequency, is gone. The result may pass through itself.
Mesh pull_back(const Mesh& wrap, const Mesh& triangles, double reach);

}  // namespace liana
