// Closed contours of a closed surface, and the cross-sections they bound.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// The closed polygons where a value given at the vertices is zero, linear in between.
std::vector<std::vector<Vec3>> zero_contours(const Mesh& closed, const std::vector<double>& value);

/// A polygon's area and second moments, in its own mean plane.
struct PolygonMoments {
  double area = 0;  ///< m²
  Vec3 centroid = Vec3::Zero();
  Vec3 wide = Vec3::UnitX();  ///< unit, the principal direction in which it is widest
  Vec3 thin = Vec3::UnitY();  ///< unit, perpendicular to wide
  double along_wide = 0;      ///< m⁴, ∫ of the squared distance along `wide` from the centroid
  double along_thin = 0;      ///< m⁴
};
PolygonMoments polygon_moments(const std::vector<Vec3>& polygon);

}  // namespace liana
