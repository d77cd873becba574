// An obstacle as a signed distance field: fast values near the surface, exact closest points anywhere; it may
// move.
#pragma once

#include <array>
#include <vector>

#include "runtime/obstacles/contact_material.h"
#include "runtime/obstacles/surface_query.h"

namespace liana {

struct SdfOptions {
  double voxel = 0;  ///< m; 0: from the mesh, see geometric_voxel()
  double sheet = 0;  ///< m; above 0 the mesh is the middle of a sheet that thick, and may be open
  double band =
      0;  ///< m on both sides of the surface where the field is accurate; 0: 3 voxels, at least 4 cm
  const char* device = "threads=1";       ///< Embree's own configuration; no answer depends on it
  unsigned threads = 0;                   ///< for the fill; 0: one per core. The field does not depend on it.
  size_t max_samples = size_t{64} << 20;  ///< 4 bytes each; a finer field throws Error{Input}
};

struct SdfSample {
  double distance;  ///< m, negative inside
  Vec3 gradient;    ///< unit, away from the inside; zero beyond the band
};

/// Where an obstacle is and how it moves: x_world = rotation x_mesh + position.
struct ObstaclePose {
  Quat rotation = Quat::Identity();
  Vec3 position = Vec3::Zero();          ///< m
  Vec3 centre = Vec3::Zero();            ///< m, world: the point that moves with `velocity`
  Vec3 velocity = Vec3::Zero();          ///< m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
};

/// m: a third of the thickness that volume over surface stands for, at most 1/128 of the longest side; at
/// least 2 mm, and so that the band takes about a hundred thousand samples.
double geometric_voxel(const Mesh& mesh, double sheet);

/// Bricks of 8³ voxels, kept only near the surface. Within the band the error is below a tenth of a voxel,
/// mostly far below: voxels in which the field bends (edges, corners, thin parts) are marked and answered by
/// Embree. Beyond the band the value keeps its sign and is a lower bound of the distance, and never less than
/// the band.
class SdfObstacle {
 public:
  /// Throws Error{Input} for an empty or non-finite mesh, and unless it is a sheet for an open or inside-out
  /// one. Shells of one mesh must not overlap (use one obstacle for each, see pieces.h).
  explicit SdfObstacle(const Mesh& mesh, const SdfOptions& options = {});

  double distance(const Vec3& x) const { return sample(x).distance; }
  SdfSample sample(const Vec3& x) const;

  /// m: no point of an upright box has a smaller distance(), if this is above zero. Otherwise that was not
  /// found out. It is never above the band.
  double least(const Vec3& centre, const Vec3& half) const;

  /// Moves it. Scaling and shear belong into the mesh, where distances stay exact. All questions and answers
  /// are in the world's frame.
  void place(const ObstaclePose& pose);
  const ObstaclePose& pose() const { return pose_; }
  bool moves() const { return moves_; }      ///< its pose has a velocity
  uint64_t state() const { return state_; }  ///< another for every field and place
  Vec3 velocity_at(const Vec3& x) const {
    return pose_.velocity + pose_.angular_velocity.cross(x - pose_.centre);
  }
  Vec3 to_mesh(const Vec3& x) const { return placed_ ? Vec3(back_ * (x - pose_.position)) : x; }
  Vec3 to_world(const Vec3& x) const { return placed_ ? Vec3(back_.transpose() * x + pose_.position) : x; }

  ContactMaterial material;  ///< of its surface

  /// Exact, at any distance; about a microsecond.
  SurfacePoint closest_point(const Vec3& x) const;
  bool shades(const Vec3& x, const Vec3& to_light) const {
    return surface_.ray_meets(to_mesh(x), placed_ ? Vec3(back_ * to_light) : to_light);
  }

  const Mesh& mesh() const { return surface_.mesh(); }  ///< in its own frame
  double voxel() const { return voxel_; }
  double band() const { return band_; }
  const Vec3& low() const { return world_low_; }    ///< corner of a box around it, m
  const Vec3& high() const { return world_high_; }  ///< the other one
  size_t bytes() const;

 private:
  static constexpr int kCellBits = 3, kCells = 1 << kCellBits, kSide = kCells + 1,
                       kSamples = kSide * kSide * kSide;
  struct Brick {
    std::array<float, kSamples> values;             // m, x fastest
    std::array<uint8_t, kCells* kCells> bent = {};  // bit x of [z * 8 + y]: ask Embree
    void corners(const Eigen::Vector3i& cell, double (&f)[8]) const {
      const float* first = &values[cell.x() + kSide * (cell.y() + kSide * cell.z())];
      for (int c = 0; c < 8; ++c) f[c] = first[(c & 1) + kSide * ((c >> 1 & 1) + kSide * (c >> 2))];
    }
  };
  SdfSample sample_mesh(const Vec3& x) const;
  double least_mesh(const Vec3& low, const Vec3& high) const;
  Vec3 brick_centre(const Eigen::Vector3i& b) const;
  void fill(Brick& brick, const Eigen::Vector3i& at) const;
  void mark_bent(Brick& brick, const Vec3& corner, const std::vector<Vec3>& gradients) const;

  SurfaceQuery surface_;
  ObstaclePose pose_;
  Mat3 back_ = Mat3::Identity();  // world's directions in the mesh's frame
  bool placed_ = false, moves_ = false;
  uint64_t state_;
  double half_sheet_ = 0;  // m
  Vec3 world_low_, world_high_;
  Vec3 low_, high_, origin_;  // with the sheet's thickness
  double voxel_, band_;
  Eigen::Vector3i bricks_;            // number along each axis
  Vec3 top_;                          // voxels along each axis
  std::vector<int32_t> brick_index_;  // into filled_, or -1
  std::vector<float> centre_value_;   // m, exact distance at the centre of each brick
  std::vector<Brick> filled_;
};

}  // namespace liana
