// Where the world, double SI vectors of Eigen, is handed over to the picture, single precision of GLM.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "mesher/base/types.h"

namespace liana {

inline glm::dvec3 to_glm(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

inline glm::vec3 to_glm_float(const Vec3& v) {
  return glm::vec3(to_glm(v));
}

/// x y z w, as shaders turn by it.
inline glm::vec4 to_glm_float(const Quat& q) {
  return glm::vec4(q.x(), q.y(), q.z(), q.w());
}

/// Linear RGB in [0, 1] as bytes. Stored as square roots, because eyes see dark tones finely; shaders square
/// them.
inline glm::u8vec4 packed_color(const Vec3& color, double opacity = 1) {
  const glm::dvec3 root = glm::sqrt(glm::clamp(to_glm(color), 0.0, 1.0));
  return {glm::u8vec3(255.0 * root + 0.5), uint8_t(255 * glm::clamp(opacity, 0.0, 1.0))};
}

}  // namespace liana
