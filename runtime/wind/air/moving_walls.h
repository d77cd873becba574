// Solids that move through the air: each has a grid of distances of its own, which moves with it.
#pragma once

#include "runtime/wind/air/air_walls.h"

namespace liana {

class MovingWalls {
 public:
  MovingWalls() = default;
  /// Corner of the air's domain, spacing and reach in m. The obstacles must outlive it; where they are now
  /// does not matter.
  MovingWalls(const Vec3& domain_low, double spacing, double reach,
              std::span<const SdfObstacle* const> obstacles, unsigned threads);

  struct Sample {
    AirWalls::Sample wall;
    float vx, vy, vz;  ///< m/s, of the solid's surface here
  };
  bool empty() const { return walls_.empty(); }
  /// Takes the obstacles where they were `before` (s) they came to their present poses. Allocates nothing.
  void place(double before);
  /// m/s, the most that any point of an obstacle within `reach` of the domain (its high corner, m) moves at.
  double top_speed(const Vec3& domain_high) const;
  /// The nearest of all, as last placed; x, y, z (m) relative to the domain's low corner.
  Sample sample(float x, float y, float z) const;

  size_t size() const { return walls_.size(); }
  /// A box around obstacle i and `reach`, m, relative to the domain's low corner.
  const Eigen::Vector3f& low(size_t i) const { return walls_[i].low; }
  const Eigen::Vector3f& high(size_t i) const { return walls_[i].high; }

 private:
  struct Wall {
    const SdfObstacle* obstacle = nullptr;
    AirWalls grid;
    float turn[9] = {};                                         // rows: from the domain's frame to the mesh's
    float shift[3] = {};                                        // m: grid place = turn x + shift
    Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = low;  // m
    Eigen::Vector3f drift = Eigen::Vector3f::Zero(), spin = drift;  // m/s at the domain's corner; rad/s
  };
  Vec3 domain_low_ = Vec3::Zero();
  double reach_ = 0;
  std::vector<Wall> walls_;
};

}  // namespace liana
