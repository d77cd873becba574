// Where a plant is near solids: the points of its particles that may touch one in the coming step.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/obstacles/sdf_obstacle.h"
#include "runtime/sim/contact/clearances.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct CollisionScene {
  std::span<const SdfObstacle* const>
      solids;                           ///< where they are at the end of the step, with their velocities
  std::optional<double> ground_height;  ///< m; the ground is a horizontal plane
};

/// What a probe of a particle finds at one solid: where it touches first, and how far that is.
struct Gap {
  size_t particle;
  uint64_t key;              ///< particle, solid and probe; ascending in the order of visits
  const SdfObstacle* solid;  ///< null: the ground
  Vec3 point;                ///< m, particle's frame: what a spring holds
  double gap;                ///< m, negative inside; now, before the solid moves
  Vec3 normal;               ///< unit, away from the solid
  bool crossed = false;      ///< an edge or a thin part of the solid goes through its axis
  bool slides = false;       ///< without friction: a blade's tip or midrib, which gives way sideways
};

/// The gaps of every probe of particles from `first` on that can get into something within dt, as they move
/// now; with dt = 0, those of the present with solids where they stand. Probes: centre and head of a particle
/// (its tail is its parent's head, unless it is loose or on a petiole), and the point between that is nearest
/// to a thin solid.
class Probes {
 public:
  /// With `clearances`, particles that these know to be clear are passed over, and those that are not may be
  /// learnt.
  const std::vector<Gap>& look(const Plant& plant, const CollisionScene& scene, double dt, size_t first = 0,
                               Clearances* clearances = nullptr);

 private:
  class View;
  void look(const Plant& plant, const CollisionScene& scene, double dt, size_t first, size_t last,
            Clearances* clearances);
  /// Whether a point is in the ground or in one of near_.
  bool inside(const Vec3& x, std::optional<const SdfObstacle*> without = {}) const;
  bool lead_out(const Plant& plant, Gap& gap) const;
  void look_at(const Plant& plant, size_t particle, double dt, const SdfObstacle* solid, uint64_t number);

  std::vector<std::pair<uint64_t, const SdfObstacle*>> near_;  // solids near the particles at hand, numbered
  double ground_ = 0;                                          // m; or minus infinity
  std::vector<Gap> gaps_;
};

}  // namespace liana
