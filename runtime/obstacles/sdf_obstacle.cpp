#include "runtime/obstacles/sdf_obstacle.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/parallel.h"

namespace liana {
namespace {

constexpr double kLeastBand = 4e-2;  // m

uint64_t new_state() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

/// Trilinear value and gradient (per voxel) inside a cell; f[x + 2y + 4z] at its corners, t in [0, 1]³.
inline double interpolate(const double (&f)[8], const Vec3& t, Vec3& gradient) {
  double along_x[4], step_x[4];
  for (int i = 0; i < 4; ++i) step_x[i] = f[2 * i + 1] - f[2 * i], along_x[i] = f[2 * i] + t.x() * step_x[i];
  const double near = along_x[0] + t.y() * (along_x[1] - along_x[0]);
  const double far = along_x[2] + t.y() * (along_x[3] - along_x[2]);
  const double x_near = step_x[0] + t.y() * (step_x[1] - step_x[0]);
  const double x_far = step_x[2] + t.y() * (step_x[3] - step_x[2]);
  const double y_near = along_x[1] - along_x[0], y_far = along_x[3] - along_x[2];
  gradient = {x_near + t.z() * (x_far - x_near), y_near + t.z() * (y_far - y_near), far - near};
  return near + t.z() * (far - near);
}

Vec3 gradient_at(const SurfacePoint& closest, const Vec3& x) {
  const Vec3 away = x - closest.point;
  // On the surface itself the direction is lost in rounding.
  if (std::abs(closest.distance) < 1e-9) return closest.normal;
  return away / closest.distance;
}

}  // namespace

double geometric_voxel(const Mesh& mesh, double sheet) {
  Vec3 low = mesh.positions.front(), high = low;
  for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  double area = 0, volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 cross = (b - a).cross(c - a);
    area += cross.norm() / 2;
    volume += (a - low).dot(cross) / 6;
  }
  const double thickness = sheet > 0 ? sheet : 2 * std::abs(volume) / area;
  const double wanted = std::min((high - low).maxCoeff() / 128, thickness / 3);
  const double affordable = fixed::cbrt(2 * kLeastBand * area / 1e5);
  return std::max({2e-3, wanted, affordable});
}

SdfObstacle::SdfObstacle(const Mesh& mesh, const SdfOptions& options)
    : surface_(mesh, options.sheet, options.device), state_(new_state()), half_sheet_(options.sheet / 2) {
  low_ = high_ = surface_.mesh().positions.front();
  for (const Vec3& p : surface_.mesh().positions) low_ = low_.cwiseMin(p), high_ = high_.cwiseMax(p);
  low_.array() -= half_sheet_;
  high_.array() += half_sheet_;
  world_low_ = low_;
  world_high_ = high_;
  voxel_ = options.voxel > 0 ? options.voxel : geometric_voxel(surface_.mesh(), options.sheet);
  band_ = options.band > 0 ? options.band : std::max(kLeastBand, 3 * voxel_);

  const double brick = kCells * voxel_;
  const Vec3 extent = high_ - low_ + Vec3::Constant(2 * (band_ + voxel_));
  const Vec3 count = (extent / brick).array().ceil();
  if (!(count.prod() < 1e7))
    throw Error(Error::Kind::Input,
                fmt::format("a voxel of {} m is too fine for an obstacle of {:.1f} m", voxel_,
                            (high_ - low_).maxCoeff()),
                "choose a larger voxel");
  bricks_ = count.cast<int>();
  origin_ = (low_ + high_) / 2 - count * (brick / 2);
  top_ = (bricks_ * kCells).cast<double>();

  brick_index_.assign(bricks_.prod(), -1);
  centre_value_.resize(brick_index_.size());
  const auto place = [&](size_t i) {
    const int x = static_cast<int>(i % bricks_.x()), rest = static_cast<int>(i / bricks_.x());
    return Eigen::Vector3i(x, rest % bricks_.y(), rest / bricks_.y());
  };
  parallel_for(
      brick_index_.size(), options.threads,
      [&](size_t i, unsigned) {
        centre_value_[i] = static_cast<float>(surface_.closest(brick_centre(place(i))).distance);
      },
      64);

  const double reach = brick * std::sqrt(3.0) / 2 + band_;  // beyond it no point of the brick is in the band
  std::vector<size_t> near;
  for (size_t i = 0; i < brick_index_.size(); ++i)
    if (std::abs(centre_value_[i]) <= reach * (1 + 1e-6)) brick_index_[i] = near.size(), near.push_back(i);
  if (near.size() * kSamples > options.max_samples)
    throw Error(Error::Kind::Input,
                fmt::format("a voxel of {} m needs {} samples, more than {}", voxel_, near.size() * kSamples,
                            options.max_samples),
                "choose a larger voxel");
  filled_.resize(near.size());
  parallel_for(
      near.size(), options.threads, [&](size_t i, unsigned) { fill(filled_[i], place(near[i])); }, 4);
}

Vec3 SdfObstacle::brick_centre(const Eigen::Vector3i& b) const {
  return origin_ + (b.cast<double>() + Vec3::Constant(0.5)) * (kCells * voxel_);
}

void SdfObstacle::fill(Brick& brick, const Eigen::Vector3i& at) const {
  const Vec3 corner = origin_ + at.cast<double>() * (kCells * voxel_);
  std::vector<Vec3> gradients(kSamples);
  double within = std::numeric_limits<double>::infinity();
  for (int z = 0, i = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x, ++i) {
        const Vec3 p = corner + Vec3(x, y, z) * voxel_;
        if (x == 0) within = std::numeric_limits<double>::infinity();  // else: one voxel from the last sample
        const SurfacePoint found = surface_.closest(p, within);
        within = std::abs(found.distance) + voxel_;
        brick.values[i] = static_cast<float>(found.distance);
        gradients[i] = gradient_at(found, p);
      }
  mark_bent(brick, corner, gradients);
}

// A field whose gradient turns by less than `turn` within a cell is off its trilinear interpolant by less
// than turn * voxel; where the surface passes, the centre is looked at as well, for what is smaller than a
// voxel.
void SdfObstacle::mark_bent(Brick& brick, const Vec3& corner, const std::vector<Vec3>& gradients) const {
  const double turn = 0.05;
  for (int z = 0; z < kCells; ++z)
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const int first = x + kSide * (y + kSide * z);
        double mean = 0, nearest = std::numeric_limits<double>::infinity();
        bool bent = false;
        for (int c = 0; c < 8; ++c) {
          const int i = first + (c & 1) + kSide * ((c >> 1 & 1) + kSide * (c >> 2));
          mean += brick.values[i] / 8;
          nearest = std::min<double>(nearest, std::abs(brick.values[i]));
          bent |= (gradients[i] - gradients[first]).squaredNorm() > turn * turn;
        }
        if (!bent && nearest < voxel_) {
          const Vec3 centre = corner + (Vec3(x, y, z) + Vec3::Constant(0.5)) * voxel_;
          bent = std::abs(surface_.closest(centre, nearest + 2 * voxel_).distance - mean) > turn * voxel_;
        }
        if (bent) brick.bent[z * kCells + y] |= uint8_t(1) << x;
      }
}

void SdfObstacle::place(const ObstaclePose& pose) {
  if (!placed_ || pose.rotation.coeffs() != pose_.rotation.coeffs() || pose.position != pose_.position)
    state_ = new_state();
  pose_ = pose;
  back_ = pose.rotation.toRotationMatrix().transpose();
  placed_ = true;
  moves_ = !pose.velocity.isZero(0) || !pose.angular_velocity.isZero(0);
  const Vec3 half = (high_ - low_) / 2, reach = back_.transpose().cwiseAbs() * half;
  const Vec3 centre = to_world((low_ + high_) / 2);
  world_low_ = centre - reach;
  world_high_ = centre + reach;
}

SdfSample SdfObstacle::sample(const Vec3& x) const {
  if (!placed_) return sample_mesh(x);
  SdfSample found = sample_mesh(to_mesh(x));
  found.gradient = back_.transpose() * found.gradient;
  return found;
}

SurfacePoint SdfObstacle::closest_point(const Vec3& x) const {
  SurfacePoint found = surface_.closest(to_mesh(x));
  if (!placed_) return found;
  found.point = to_world(found.point);
  found.normal = back_.transpose() * found.normal;
  return found;
}

SdfSample SdfObstacle::sample_mesh(const Vec3& x) const {
  const Vec3 place = (x - origin_) / voxel_;
  const bool in_grid = place.x() >= 0 && place.x() < top_.x() && place.y() >= 0 && place.y() < top_.y() &&
                       place.z() >= 0 && place.z() < top_.z();
  if (!in_grid) return {(x - x.cwiseMax(low_).cwiseMin(high_)).norm(), Vec3::Zero()};
  const Eigen::Vector3i cell(static_cast<int>(place.x()), static_cast<int>(place.y()),
                             static_cast<int>(place.z()));
  const Eigen::Vector3i b(cell.x() >> kCellBits, cell.y() >> kCellBits, cell.z() >> kCellBits);
  const Eigen::Vector3i in = cell - b * kCells;
  const size_t at = b.x() + size_t(bricks_.x()) * (b.y() + size_t(bricks_.y()) * b.z());
  if (brick_index_[at] < 0) {
    const Vec3 away = x - brick_centre(b);
    const double centre = centre_value_[at];
    // The distance changes by no more than the way from the centre.
    const double bound = std::max(band_, std::abs(centre) - away.norm());
    return {std::copysign(bound, centre), Vec3::Zero()};
  }
  const Brick& brick = filled_[brick_index_[at]];
  if (brick.bent[in.z() * kCells + in.y()] >> in.x() & 1) {
    // No further than by way of the nearest corner.
    const Eigen::Vector3i near = (place - cell.cast<double>()).array().round().cast<int>();
    const double value =
        brick.values[near.x() + in.x() + kSide * (near.y() + in.y() + kSide * (near.z() + in.z()))];
    const double way = voxel_ * (place - (cell + near).cast<double>()).norm();
    const SurfacePoint exact = surface_.closest(x, (std::abs(value) + way) * (1 + 1e-6));
    return {exact.distance, gradient_at(exact, x)};
  }
  double corners[8];
  brick.corners(in, corners);
  SdfSample result;
  result.distance = interpolate(corners, place - cell.cast<double>(), result.gradient);
  result.gradient.normalize();
  return result;
}

double SdfObstacle::least(const Vec3& centre, const Vec3& half) const {
  const Vec3 low = centre - half, high = centre + half;
  // The field leaves the box around the solid with a distance of zero or more, and errs by little.
  const Vec3 apart = (low - world_high_).cwiseMax(world_low_ - high).cwiseMax(0.0);
  if (apart.squaredNorm() > 4 * band_ * band_) return band_;
  if (!placed_) return least_mesh(low, high);
  const Vec3 within = to_mesh(centre), reach = back_.cwiseAbs() * half;
  return least_mesh(within - reach, within + reach);
}

// In a cell the field is multilinear, so on the part of the box in it, it is least at a corner of that part;
// in a bent one it is a distance, which changes by no more than the way; that to a convex solid is no smaller
// than that to the plane between.
double SdfObstacle::least_mesh(const Vec3& low, const Vec3& high) const {
  constexpr double kMostCells = 100;
  const Vec3 from = (low - origin_) / voxel_, to = (high - origin_) / voxel_;
  // Beyond the grid nothing is nearer than the band.
  if (!from.allFinite() || !to.allFinite()) return -std::numeric_limits<double>::infinity();
  const Eigen::Vector3i first = from.cwiseMax(0.0).cwiseMin(top_).cast<int>(),
                        last = to.cwiseMax(0.0).cwiseMin(top_ - Vec3::Ones()).cast<int>();
  double least = band_;
  const auto beyond_way = [&](const Vec3& place, double way) {
    return surface_.closest(origin_ + voxel_ * place).distance - voxel_ * way;
  };
  std::optional<double> plane;
  const auto beyond_plane = [&] {
    if (plane) return *plane;
    const Vec3 middle = (low + high) / 2;
    const SurfacePoint found = surface_.closest(middle);
    const Vec3 normal = gradient_at(found, middle);
    return *(plane = found.distance - normal.cwiseAbs().dot(high - low) / 2);
  };
  if ((last - first).minCoeff() < 0) return least;
  if ((last - first + Eigen::Vector3i::Ones()).cast<double>().prod() > kMostCells)
    return -std::numeric_limits<double>::infinity();
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const Eigen::Vector3i cell(x, y, z), b = cell / kCells, in = cell - b * kCells;
        const size_t at = b.x() + size_t(bricks_.x()) * (b.y() + size_t(bricks_.y()) * b.z());
        if (brick_index_[at] < 0) {
          if (centre_value_[at] < 0) return -std::numeric_limits<double>::infinity();
          continue;
        }
        const Vec3 begin = (from - cell.cast<double>()).cwiseMax(0.0).cwiseMin(1.0),
                   end = (to - cell.cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
        const Brick& brick = filled_[brick_index_[at]];
        if (brick.bent[in.z() * kCells + in.y()] >> in.x() & 1) {
          least = std::min(least, surface_.convex() ? beyond_plane()
                                                    : beyond_way(cell.cast<double>() + (begin + end) / 2,
                                                                 (end - begin).norm() / 2));
        } else {
          double corners[8];
          brick.corners(in, corners);
          Vec3 gradient;
          for (int c = 0; c < 8; ++c) {
            const Vec3 t(c & 1 ? end.x() : begin.x(), c & 2 ? end.y() : begin.y(),
                         c & 4 ? end.z() : begin.z());
            least = std::min(least, interpolate(corners, t, gradient));
          }
        }
        if (least <= 0) return least;
      }
  return least;
}

size_t SdfObstacle::bytes() const {
  return filled_.size() * sizeof(Brick) + brick_index_.size() * (sizeof(int32_t) + sizeof(float));
}

}  // namespace liana
