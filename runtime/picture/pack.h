// Colours as the graphics card takes them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "mesher/base/types.h"

namespace liana {

/// Linear RGB in [0, 1] as bytes. Stored as square roots, because eyes see dark tones finely; shaders square
/// them.
inline std::array<uint8_t, 4> packed_color(const Vec3& color) {
  std::array<uint8_t, 4> packed{0, 0, 0, 255};
  for (int i = 0; i < 3; ++i) packed[i] = uint8_t(255 * std::sqrt(std::clamp(color[i], 0.0, 1.0)) + 0.5);
  return packed;
}

}  // namespace liana
