// The shift, turn and zoom of a picture, seen in points of which many move on their own.
#pragma once

#include <optional>
#include <vector>

#include "materials/video/tracks/point_tracks.h"

namespace liana {

/// Shift, turn and zoom that take `from` to `to` with the least sum of squares; only a shift for one pair.
Eigen::Affine2d least_squares_similarity(const std::vector<Vec2>& from, const std::vector<Vec2>& to);

struct SimilarityFit {
  Eigen::Affine2d transform = Eigen::Affine2d::Identity();  ///< from `now` to `before`
  std::vector<uint8_t> inlier;                              ///< per pair
  size_t inliers = 0;
};

/// Random sample consensus [Fischler & Bolles 1981] over pairs of points (NaN in either: no pair), refined by
/// least squares over the pairs that agree within `tolerance` pixels. Nothing when fewer than `fewest` agree.
/// Deterministic.
std::optional<SimilarityFit> fit_similarity(const std::vector<Vec2>& now, const std::vector<Vec2>& before,
                                            double tolerance, size_t fewest);

}  // namespace liana
