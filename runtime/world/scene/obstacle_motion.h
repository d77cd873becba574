// How an obstacle of a scene moves: steadily, to and fro, or from keyframe to keyframe; rigidly.
#pragma once

#include <vector>

#include "materials/law/toml_table.h"
#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {

struct ObstacleMotion {
  struct Key {
    double time;    // s
    Vec3 offset;    // m, from where the obstacle is modelled
    Quat rotation;  // about the pivot
    template <class Archive>
    void persist(Archive& a) {
      a(time, offset, rotation);
    }
  };
  Vec3 pivot = Vec3::Zero();     ///< m, world, where the obstacle is modelled
  Vec3 velocity = Vec3::Zero();  ///< m/s
  Vec3 swing = Vec3::Zero();     ///< m, amplitude
  double period = 1;             ///< s, of the swing
  Vec3 turn = Vec3::Zero();      ///< rad/s, about the pivot
  double start = 0, stop = 1e9;  ///< s: it rests before and after
  std::vector<Key> keys;         ///< ascending times; eased, so that speeds are continuous

  /// Where it is at time `to` (s), with the velocities that bring it there from where it was at `from`.
  ObstaclePose between(double from, double to) const;

  template <class Archive>
  void persist(Archive& a) {
    a(pivot, velocity, swing, period, turn, start, stop, keys);
  }
};

/// Reads [obstacle.motion]. Throws Error{Input} with file and line.
ObstacleMotion read_obstacle_motion(const TomlTable& table, const Vec3& pivot);

/// Degrees about x, then y, then z of the world.
Quat rotation_from_degrees(const Vec3& degrees);

}  // namespace liana
