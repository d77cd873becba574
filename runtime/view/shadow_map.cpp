#include "runtime/view/shadow_map.h"

#include <epoxy/gl.h>

#include <glm/gtc/matrix_transform.hpp>

#include "mesher/base/error.h"
#include "runtime/picture/glm_types.h"

namespace liana {

SunView sun_view(const BoundingBox& given, const Vec3& to_sun) {
  BoundingBox box = given;
  if (box.empty()) box.add(Vec3::Zero(), 1);
  constexpr double kMargin = 0.02;  // m
  const Vec3 back = to_sun.normalized(), up = back.cross(back.unitOrthogonal());
  const glm::dmat4 view = glm::lookAt(to_glm(back), glm::dvec3(0), to_glm(up));
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 seen =
        view * glm::dvec4(corner & 1 ? box.high.x() : box.low.x(), corner & 2 ? box.high.y() : box.low.y(),
                          corner & 4 ? box.high.z() : box.low.z(), 1);
    low = glm::min(low, seen - kMargin), high = glm::max(high, seen + kMargin);
  }
  // The ground below the box receives its shadow: reach as far down the rays as y = 0.
  low.z -= std::max(0.0, box.high.y()) / std::max(0.05, back.y());
  const glm::dmat4 to_clip = glm::ortho(low.x, high.x, low.y, high.y, -high.z, -low.z) * view;
  const glm::dmat4 to_unit = glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(0.5)), glm::dvec3(0.5));
  return {glm::mat4(to_clip), glm::mat4(to_unit * to_clip), std::max(high.x - low.x, high.y - low.y)};
}

ShadowMap::ShadowMap(int size) : size_(size) {
  glBindTexture(GL_TEXTURE_2D, depth_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "shadow map is incomplete");
}

void ShadowMap::bind_and_clear() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glViewport(0, 0, size_, size_);
  glClear(GL_DEPTH_BUFFER_BIT);
}

}  // namespace liana
