#include "mesher/geometry/similarity.h"

#include <cmath>

namespace liana {

Vec3 mean_position(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Similarity best_similarity(std::span<const Vec3> from, std::span<const Vec3> to) {
  const Vec3 from_mean = mean_position(from), to_mean = mean_position(to);
  Mat3 covariance = Mat3::Zero();
  double from_variance = 0, to_variance = 0;
  for (size_t i = 0; i < from.size(); ++i) {
    const Vec3 a = from[i] - from_mean, b = to[i] - to_mean;
    covariance += b * a.transpose();
    from_variance += a.squaredNorm(), to_variance += b.squaredNorm();
  }
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign = Vec3::Ones();
  sign[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  Similarity s;
  s.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  s.scale = std::sqrt(to_variance / from_variance);
  s.translation = to_mean - s.scale * (s.rotation * from_mean);
  return s;
}

}  // namespace liana
