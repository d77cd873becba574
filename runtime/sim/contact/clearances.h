// Which particles are clear of everything that stands still, and how far each may move before that must be
// looked at again.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "runtime/obstacles/sdf_obstacle.h"
#include "runtime/sim/model/plant.h"
#include "runtime/sim/model/remap.h"

namespace liana {

/// One per plant. Bounds only: whoever asks decides as if it had looked.
///
/// In a box around the particle that is wider than it by `room` on all sides, the field of every solid that
/// stands still, and the height above the ground, is `least` or more. While the particle has not left the
/// box, that is so for all its points.
class Clearances {
 public:
  /// Forgets all when solids came, went, moved or came to rest, or when the ground rose.
  void begin(size_t particles, std::span<const SdfObstacle* const> solids, std::optional<double> ground);

  /// Whether no probe of the particle can touch what stands still, now or within dt as it moves now, so that
  /// Contacts makes no spring.
  bool clear(const Plant& plant, size_t particle, double dt) const;

  /// Looks how much room the particle has, unless it was found to have none a few calls ago.
  void learn(const Plant& plant, size_t particle, std::span<const SdfObstacle* const> solids);

  void follow(const Remap& remap);

 private:
  struct Known {
    std::array<float, 3> position{};     // m; what these are off is taken from the room
    std::array<float, 4> orientation{};  // x, y, z, w
    std::array<float, 3> half{};         // m: length, width, thickness
    float room = -1, least = 0;          // m
  };
  /// No point of the particle is further from where it was.
  static double moved(const Known& known, const Particle& particle, const Motion& motion);
  double least(const Vec3& centre, const Vec3& half, std::span<const SdfObstacle* const> solids) const;

  std::vector<Known> known_;
  std::vector<uint8_t> wait_;     // calls until it is looked at again
  std::vector<uint64_t> states_;  // of the solids; 0 for one that moves
  std::optional<double> ground_;  // m
};

}  // namespace liana
