// How far the nearest solid is, anywhere in the air's domain: obstacles and ground on one coarse grid.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/sim/collision/sdf_obstacle.h"

namespace liana {

/// Distances beyond `reach` are not told apart. The grid is as coarse as the air itself, so that a read costs
/// nanoseconds; a solid thinner than a grid cell still stops the air (it has a distance of zero in its
/// middle, and air turns back well before).
class AirWalls {
 public:
  AirWalls() = default;
  /// Domain and spacing in m. Asks the obstacles once; they must stand still.
  AirWalls(const Vec3& low, const Vec3& high, double spacing, double reach,
           std::span<const SdfObstacle* const> obstacles, std::optional<double> ground_height,
           unsigned threads);

  struct Sample {
    float distance;  ///< m, negative inside
    float x, y, z;   ///< unit, away from the solid; zero where the field has no slope
  };
  bool empty() const { return values_.empty(); }
  /// x, y, z relative to the domain's low corner, m; taken into the domain when outside.
  Sample sample(float x, float y, float z) const;
  /// Least distance in a box, by its centre and half diagonal: may be less than the true one.
  float least_near(float x, float y, float z, float half_diagonal) const {
    return sample(x, y, z).distance - half_diagonal;
  }

 private:
  float spacing_ = 1;
  int size_[3] = {0, 0, 0};
  std::vector<float> values_;  // m, x fastest
};

}  // namespace liana
