#include "runtime/view/shadow_map.h"

#include <epoxy/gl.h>

#include "mesher/base/error.h"

namespace liana {

SunView sun_view(const BoundingBox& given, const Vec3& to_sun) {
  BoundingBox box = given;
  if (box.empty()) box.add(Vec3::Zero(), 1);
  const Vec3 back = to_sun.normalized(), side = back.unitOrthogonal(), up = back.cross(side);
  Mat3 rotation;
  rotation << side.transpose(), up.transpose(), back.transpose();
  BoundingBox turned;
  for (int corner = 0; corner < 8; ++corner)
    turned.add(
        rotation * Vec3(corner & 1 ? box.high.x() : box.low.x(), corner & 2 ? box.high.y() : box.low.y(),
                        corner & 4 ? box.high.z() : box.low.z()),
        0.02);
  // The ground below the box receives its shadow: reach as far down the rays as y = 0.
  turned.low.z() -= std::max(0.0, box.high.y()) / std::max(0.05, back.y());
  const Vec3 half = (turned.high - turned.low) / 2, middle = (turned.high + turned.low) / 2;
  Eigen::Matrix4d to_clip = Eigen::Matrix4d::Identity();
  const Vec3 scale(1 / half.x(), 1 / half.y(), -1 / half.z());  // nearer the sun = smaller depth
  to_clip.topLeftCorner<3, 3>() = scale.asDiagonal() * rotation;
  to_clip.topRightCorner<3, 1>() = -scale.cwiseProduct(middle);
  Eigen::Matrix4d to_texture = Eigen::Matrix4d::Identity();
  to_texture.topLeftCorner<3, 3>() *= 0.5;
  to_texture.topRightCorner<3, 1>().setConstant(0.5);
  return {to_clip.cast<float>(), (to_texture * to_clip).cast<float>(), 2 * std::max(half.x(), half.y())};
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
