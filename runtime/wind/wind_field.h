// What moves the air: anything that knows its velocity at a place and time.
#pragma once

#include "mesher/base/types.h"

namespace liana {

class WindField {
 public:
  virtual ~WindField() = default;
  /// m/s, at a point of the world (m) and a time (s). Safe to ask from several threads.
  virtual Vec3 velocity(const Vec3& position, double time) const = 0;
};

}  // namespace liana
