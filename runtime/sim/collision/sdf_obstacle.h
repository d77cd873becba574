// A solid obstacle as a signed distance field: fast values near the surface, exact closest points anywhere.
#pragma once

#include <array>
#include <vector>

#include "runtime/sim/collision/surface_query.h"

namespace liana {

struct SdfOptions {
  double voxel = 0;  ///< m; 0: 1/128 of the longest side of the mesh, at least 2 mm
  double band =
      0;  ///< m on both sides of the surface where the field is accurate; 0: 3 voxels, at least 4 cm
  unsigned threads = 0;                   ///< for the fill; 0: one per core. The field does not depend on it.
  size_t max_samples = size_t{64} << 20;  ///< 4 bytes each; a finer field throws Error{Input}
};

struct SdfSample {
  double distance;  ///< m, negative inside
  Vec3 gradient;    ///< unit, away from the inside; zero beyond the band
};

/// Bricks of 8³ voxels, kept only near the surface. Within the band the error is below a tenth of a voxel,
/// mostly far below: voxels in which the field bends (edges, corners, thin parts) are marked and answered by
/// Embree. Beyond the band the value keeps its sign and is a lower bound of the distance, and never less than
/// the band.
class SdfObstacle {
 public:
  /// Throws Error{Input} for an open, inside-out, empty or non-finite mesh. Shells of one mesh must not
  /// overlap (use one obstacle for each).
  explicit SdfObstacle(const Mesh& mesh, const SdfOptions& options = {});

  double distance(const Vec3& x) const { return sample(x).distance; }
  SdfSample sample(const Vec3& x) const;

  /// Exact, at any distance; about a microsecond.
  SurfacePoint closest_point(const Vec3& x) const { return surface_.closest(x); }
  bool shades(const Vec3& x, const Vec3& to_light) const { return surface_.ray_meets(x, to_light); }

  const Mesh& mesh() const { return surface_.mesh(); }
  double voxel() const { return voxel_; }
  double band() const { return band_; }
  const Vec3& low() const { return low_; }    ///< corner of the mesh's box, m
  const Vec3& high() const { return high_; }  ///< the other one
  size_t bytes() const;

 private:
  static constexpr int kCells = 8, kSide = kCells + 1, kSamples = kSide * kSide * kSide;
  struct Brick {
    std::array<float, kSamples> values;             // m, x fastest
    std::array<uint8_t, kCells* kCells> bent = {};  // bit x of [z * 8 + y]: ask Embree
  };
  Vec3 brick_centre(const Eigen::Vector3i& b) const;
  void fill(Brick& brick, const Eigen::Vector3i& at) const;
  void mark_bent(Brick& brick, const Vec3& corner, const std::vector<Vec3>& gradients) const;

  SurfaceQuery surface_;
  Vec3 low_, high_, origin_;
  double voxel_, band_;
  Eigen::Vector3i bricks_;            // number along each axis
  std::vector<int32_t> brick_index_;  // into filled_, or -1
  std::vector<float> centre_value_;   // m, exact distance at the centre of each brick
  std::vector<Brick> filled_;
};

}  // namespace liana
