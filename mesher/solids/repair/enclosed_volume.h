// What goes with a part of a surface that is left out.
#pragma once

#include <cmath>

#include "mesher/geometry/mesh_checks.h"

namespace liana {

/// m³ between a part of a surface, wound alike, and the cone from its rim to the rim's middle: none for what
/// is flat, the whole for what is closed.
inline double enclosed_volume(const Mesh& part) {
  const Adjacency adjacency = find_adjacency(part);
  Vec3 middle = Vec3::Zero();
  int count = 0;
  for (size_t i = 0; i < part.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (adjacency.across[i][k] == Adjacency::kNone) middle += part.positions[part.triangles[i][k]], ++count;
  if (count > 0) middle /= count;
  double six_volumes = 0;
  for (const auto& [a, b, c] : part.triangles)
    six_volumes +=
        (part.positions[a] - middle).dot((part.positions[b] - middle).cross(part.positions[c] - middle));
  return std::abs(six_volumes) / 6;
}

}  // namespace liana
