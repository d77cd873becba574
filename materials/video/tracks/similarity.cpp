#include "materials/video/tracks/similarity.h"

#include <complex>

#include "mesher/base/random.h"

namespace liana {
namespace {

Eigen::Affine2d least_squares(const std::vector<Vec2>& from, const std::vector<Vec2>& to,
                              const std::vector<size_t>& chosen) {
  std::vector<Vec2> a, b;
  for (const size_t i : chosen) a.push_back(from[i]), b.push_back(to[i]);
  return least_squares_similarity(a, b);
}

std::vector<size_t> agreeing(const Eigen::Affine2d& transform, const std::vector<Vec2>& now,
                             const std::vector<Vec2>& before, const std::vector<size_t>& pairs,
                             double tolerance) {
  std::vector<size_t> agree;
  for (const size_t i : pairs)
    if ((transform * now[i] - before[i]).norm() < tolerance) agree.push_back(i);
  return agree;
}

}  // namespace

Eigen::Affine2d least_squares_similarity(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
  // As complex numbers: w = a z + b, with a = Σ conj(z − z̄)(w − w̄) / Σ |z − z̄|².
  using Complex = std::complex<double>;
  const double count = static_cast<double>(from.size());
  Vec2 from_mean = Vec2::Zero(), to_mean = Vec2::Zero();
  for (size_t i = 0; i < from.size(); ++i) from_mean += from[i] / count, to_mean += to[i] / count;
  Complex top = 0;
  double bottom = 0;
  for (size_t i = 0; i < from.size(); ++i) {
    const Vec2 z = from[i] - from_mean, w = to[i] - to_mean;
    top += std::conj(Complex(z.x(), z.y())) * Complex(w.x(), w.y());
    bottom += z.squaredNorm();
  }
  const Complex a = bottom > 0 ? top / bottom : Complex(1);
  Eigen::Affine2d transform = Eigen::Affine2d::Identity();
  transform.linear() << a.real(), -a.imag(), a.imag(), a.real();
  transform.translation() = to_mean - transform.linear() * from_mean;
  return transform;
}

std::optional<SimilarityFit> fit_similarity(const std::vector<Vec2>& now, const std::vector<Vec2>& before,
                                            double tolerance, size_t fewest) {
  constexpr int kSamples = 200;  // one of them is all background with certainty > 0.999 when a fifth is
  std::vector<size_t> pairs, best;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i].allFinite() && before[i].allFinite()) pairs.push_back(i);
  if (pairs.size() < std::max<size_t>(2, fewest)) return std::nullopt;
  Random random(1, "similarity");
  for (int sample = 0; sample < kSamples; ++sample) {
    const size_t i = pairs[random.next() % pairs.size()], j = pairs[random.next() % pairs.size()];
    if ((now[i] - now[j]).norm() < 20 * tolerance) continue;  // too near to tell a turn
    const auto agree = agreeing(least_squares(now, before, {i, j}), now, before, pairs, tolerance);
    if (agree.size() > best.size()) best = agree;
  }
  if (best.size() < fewest) return std::nullopt;
  SimilarityFit fit;
  fit.transform = least_squares(now, before, best);
  best = agreeing(fit.transform, now, before, pairs, tolerance);
  if (best.size() < fewest) return std::nullopt;
  fit.inlier.assign(now.size(), 0);
  for (const size_t i : best) fit.inlier[i] = 1;
  fit.inliers = best.size();
  return fit;
}

}  // namespace liana
