// Rotation, translation and uniform scale from one set of points to another.
#pragma once

#include <span>

#include "mesher/base/types.h"

namespace liana {

/// x' = scale · rotation · x + translation
struct Similarity {
  Mat3 rotation = Mat3::Identity();
  double scale = 1;
  Vec3 translation = Vec3::Zero();  ///< m

  Vec3 point(const Vec3& p) const { return scale * (rotation * p) + translation; }
  Vec3 inverse_point(const Vec3& p) const { return rotation.transpose() * (p - translation) / scale; }
};

Vec3 mean_position(std::span<const Vec3> points);

/// The least squares similarity between as many points each, without reflection [Umeyama 1991] Eq. 40-43.
Similarity best_similarity(std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace liana
