// The obstacles of a scene as distance fields, and where those that move are.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/world/scene/scene.h"

namespace liana {

class WorldObstacles {
 public:
  /// Throws Error{Usage} when the scene has obstacles but no solids (see Scene::solids), Error{Input} naming
  /// the obstacle whose solid no field can be made of.
  explicit WorldObstacles(const Scene& scene);

  /// To where they are at `to` (s), with the velocities that bring them there from where they are at `from`.
  void move(double from, double to);

  std::span<const SdfObstacle* const> all() const { return pointers_; }
  std::span<const SdfObstacle* const> moving() const { return all().first(motions_.size()); }
  std::span<const SdfObstacle* const> standing() const { return all().subspan(motions_.size()); }

 private:
  std::vector<std::unique_ptr<SdfObstacle>> fields_;  // those that move first
  std::vector<const SdfObstacle*> pointers_;
  std::vector<ObstacleMotion> motions_;  // of those that move
};

}  // namespace liana
