// What moves the air: anything that knows its velocity at a place and time.
#pragma once

#include <span>

#include "mesher/base/types.h"

namespace liana {

class WindField {
 public:
  virtual ~WindField() = default;
  /// m/s, at a point of the world (m) and a time (s). Safe to ask from several threads.
  virtual Vec3 velocity(const Vec3& position, double time) const = 0;
  /// The same at many points, into `out` of equal size: faster for most winds. Allocates nothing.
  virtual void velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
    for (size_t i = 0; i < positions.size(); ++i) out[i] = velocity(positions[i], time);
  }
};

}  // namespace liana
