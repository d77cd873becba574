// A polygon as triangles.
#pragma once

#include <span>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Appends the triangles of a polygon with three or more corners, wound as it is: ears are cut off as seen
/// along its mean normal (Newell), so that concave outlines keep their shape; above 256 corners a fan.
void append_polygon(std::span<const uint32_t> corners, const std::vector<Vec3>& positions,
                    std::vector<Triangle>& triangles);

}  // namespace liana
