// Depth as the sun sees it.
#pragma once

#include "runtime/picture/draw_scene.h"
#include "runtime/view/gl_objects.h"

namespace liana {

/// The sun's orthographic view of a box.
struct SunView {
  glm::mat4 to_clip;     ///< world -> the sun's clip space
  glm::mat4 to_texture;  ///< world -> [0, 1]
  double extent;         ///< m, of the longer side that the map covers
};

/// Encloses the box; to_sun need not be a unit vector.
SunView sun_view(const BoundingBox& box, const Vec3& to_sun);

class ShadowMap {
 public:
  explicit ShadowMap(int size);
  int size() const { return size_; }
  void bind_and_clear() const;
  unsigned texture() const { return depth_.id(); }

 private:
  int size_;
  GlObject frame_{GlKind::Framebuffer}, depth_{GlKind::Texture};
};

}  // namespace liana
