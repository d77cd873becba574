#include "materials/video/modes/main_direction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mesher/base/types.h"

namespace liana {

Stretch longest_stretch(const PointTrack& track, size_t from, size_t to, size_t most_bridged) {
  Stretch best, now;
  size_t last_seen = 0;
  to = std::min(to, track.path.size());
  for (size_t frame = from; frame < to; ++frame) {
    if (!track.seen(frame)) continue;
    const size_t gap = now.path.empty() ? 0 : frame - last_seen - 1;
    if (now.path.empty() || gap > most_bridged) {
      if (now.path.size() > best.path.size()) best = now;
      now = {frame, {}, 0};
    } else {
      const Vec2 before = now.path.back(), step = (track.path[frame] - before) / static_cast<double>(gap + 1);
      for (size_t i = 1; i <= gap; ++i) now.path.push_back(before + static_cast<double>(i) * step);
      now.bridged += gap;
    }
    now.path.push_back(track.path[frame]);
    last_seen = frame;
  }
  return now.path.size() > best.path.size() ? now : best;
}

MainDirection main_direction(const std::vector<Vec2>& path) {
  MainDirection result;
  if (path.empty()) return result;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : path) mean += p / static_cast<double>(path.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Vec2& p : path) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(covariance);
  result.direction = principal.eigenvectors().col(1);
  if (result.direction.x() + 1e-3 * result.direction.y() < 0) result.direction = -result.direction;
  const double all = covariance.trace();
  if (all > 0) result.share = principal.eigenvalues()[1] / all;
  for (const Vec2& p : path) result.signal.push_back(result.direction.dot(p - mean));
  return result;
}

std::vector<Vec2> without_drift(const std::vector<Vec2>& path, double frames_per_second, double lowest) {
  // Response of a Gaussian of spread s: exp(−(2π f s)²/2), one half at lowest / 2.
  const double spread = std::sqrt(2 * std::log(2.0)) / (kPi * lowest) * frames_per_second;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4 * spread));
  const auto count = static_cast<std::ptrdiff_t>(path.size());
  std::vector<Vec2> fast;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    // A local straight line rather than a local mean: the ends of the record are not bent.
    double s0 = 0, s1 = 0, s2 = 0;
    Vec2 p0 = Vec2::Zero(), p1 = Vec2::Zero();
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j < std::min(count, i + reach + 1); ++j) {
      const double t = static_cast<double>(j - i), w = std::exp(-0.5 * t * t / (spread * spread));
      s0 += w, s1 += w * t, s2 += w * t * t;
      p0 += w * path[static_cast<size_t>(j)], p1 += w * t * path[static_cast<size_t>(j)];
    }
    const double determinant = s0 * s2 - s1 * s1;
    const Vec2 slow = determinant > 0 ? Vec2((s2 * p0 - s1 * p1) / determinant) : Vec2(p0 / s0);
    fast.push_back(path[static_cast<size_t>(i)] - slow);
  }
  return fast;
}

}  // namespace liana
