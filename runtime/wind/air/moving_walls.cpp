#include "runtime/wind/air/moving_walls.h"

#include <algorithm>

#include "runtime/sim/model/rotation.h"

namespace liana {

MovingWalls::MovingWalls(const Vec3& domain_low, double spacing, double reach,
                         std::span<const SdfObstacle* const> obstacles, unsigned threads)
    : domain_low_(domain_low), reach_(reach) {
  for (const SdfObstacle* obstacle : obstacles) {
    walls_.push_back({});
    walls_.back().obstacle = obstacle;
    walls_.back().grid = AirWalls(*obstacle, spacing, reach, threads);
  }
  place(0);
}

// The rigid motion is turned back: about the pose's centre, which itself moved steadily.
void MovingWalls::place(double before) {
  for (Wall& wall : walls_) {
    const ObstaclePose& pose = wall.obstacle->pose();
    const double angle = -before * pose.angular_velocity.norm();
    const Quat back =
        angle == 0 ? Quat::Identity() : rotation_about(pose.angular_velocity.normalized(), angle);
    const Vec3 centre = pose.centre - before * pose.velocity;
    const Vec3 position = centre + back * (pose.position - pose.centre) - domain_low_;
    const Mat3 to_mesh = (back * pose.rotation).toRotationMatrix().transpose();
    const Vec3 shift = -(to_mesh * position) - wall.grid.low();
    for (int k = 0; k < 9; ++k) wall.turn[k] = static_cast<float>(to_mesh(k / 3, k % 3));
    for (int k = 0; k < 3; ++k) wall.shift[k] = static_cast<float>(shift[k]);
    wall.spin = pose.angular_velocity.cast<float>();
    wall.drift = (pose.velocity - pose.angular_velocity.cross(centre - domain_low_)).cast<float>();
    const Vec3 half = wall.grid.extent() / 2, box = to_mesh.transpose().cwiseAbs() * half;
    const Vec3 middle = to_mesh.transpose() * (wall.grid.low() + half) + position;
    wall.low = (middle - box).cast<float>(), wall.high = (middle + box).cast<float>();
  }
}

double MovingWalls::top_speed(const Vec3& domain_high) const {
  double top = 0;
  for (const Wall& wall : walls_) {
    const SdfObstacle& obstacle = *wall.obstacle;
    const Vec3 gap = (obstacle.low() - domain_high).cwiseMax(domain_low_ - obstacle.high());
    if (!obstacle.moves() || !(gap.maxCoeff() < reach_)) continue;
    const double radius = (obstacle.high() - obstacle.low()).norm() / 2 +
                          ((obstacle.low() + obstacle.high()) / 2 - obstacle.pose().centre).norm();
    top = std::max(top, obstacle.pose().velocity.norm() + radius * obstacle.pose().angular_velocity.norm());
  }
  return top;
}

MovingWalls::Sample MovingWalls::sample(float x, float y, float z) const {
  Sample nearest{{static_cast<float>(reach_), 0, 0, 0}, 0, 0, 0};
  for (const Wall& w : walls_) {
    if (x < w.low[0] || y < w.low[1] || z < w.low[2] || x > w.high[0] || y > w.high[1] || z > w.high[2])
      continue;
    const float* m = w.turn;
    const AirWalls::Sample own = w.grid.sample(m[0] * x + m[1] * y + m[2] * z + w.shift[0],
                                               m[3] * x + m[4] * y + m[5] * z + w.shift[1],
                                               m[6] * x + m[7] * y + m[8] * z + w.shift[2]);
    if (own.distance >= nearest.wall.distance) continue;
    nearest.wall = {own.distance, m[0] * own.x + m[3] * own.y + m[6] * own.z,
                    m[1] * own.x + m[4] * own.y + m[7] * own.z, m[2] * own.x + m[5] * own.y + m[8] * own.z};
    nearest.vx = w.drift[0] + w.spin[1] * z - w.spin[2] * y;
    nearest.vy = w.drift[1] + w.spin[2] * x - w.spin[0] * z;
    nearest.vz = w.drift[2] + w.spin[0] * y - w.spin[1] * x;
  }
  return nearest;
}

}  // namespace liana
