// How far the nearest solid is, on a coarse grid: obstacles that stand still and the ground, in the air's
// domain.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/obstacles/sdf_obstacle.h"

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
  /// Of one obstacle and `reach` around it, in the frame of its mesh, wherever it is.
  AirWalls(const SdfObstacle& obstacle, double spacing, double reach, unsigned threads);

  struct Sample {
    float distance;  ///< m, negative inside
    float x, y, z;   ///< unit, away from the solid; zero where the field has no slope
  };
  bool empty() const { return values_.empty(); }
  const Vec3& low() const { return low_; }  ///< corner of the grid, m
  Vec3 extent() const { return spacing_ * Vec3(size_[0] - 1, size_[1] - 1, size_[2] - 1); }  ///< m
  /// x, y, z relative to the low corner, m; taken into the domain when outside.
  Sample sample(float x, float y, float z) const;
  /// Least distance in a box, by its centre and half diagonal: may be less than the true one.
  float least_near(float x, float y, float z, float half_diagonal) const {
    return sample(x, y, z).distance - half_diagonal;
  }

 private:
  template <class Distance>
  void fill(const Vec3& high, double spacing, double reach, unsigned threads, const Distance& distance);

  Vec3 low_ = Vec3::Zero();
  float spacing_ = 1;
  int size_[3] = {0, 0, 0};
  std::vector<float> values_;  // m, x fastest
};

}  // namespace liana
