#include "mesher/geometry/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace liana {
namespace {

/// Finds the place near a position: a grid whose cells are larger than the tolerance, so that a position
/// mostly looks into one cell, and into its neighbours when it lies within the tolerance of the cell's side.
/// Not so large that many places could crowd into one cell.
class PlaceGrid {
 public:
  PlaceGrid(const Vec3& low, double tolerance, size_t positions)
      : low_(low),
        tolerance_(tolerance),
        cell_(16 * tolerance),
        first_(std::bit_ceil(std::max<size_t>(positions, 16)), kEnd) {}

  /// Index of the place within the tolerance; a new one at the end of `places` if there is none.
  uint32_t find_or_add(const Vec3& position, std::vector<Vec3>& places) {
    const Eigen::Array3d scaled = (position - low_).array() / cell_;
    const Eigen::Array3d reach = Eigen::Array3d::Constant(tolerance_ / cell_);
    const auto first = (scaled - reach).floor().eval(), last = (scaled + reach).floor().eval();
    for (double x = first.x(); x <= last.x(); ++x)
      for (double y = first.y(); y <= last.y(); ++y)
        for (double z = first.z(); z <= last.z(); ++z) {
          for (uint32_t p = first_[slot(x, y, z)]; p != kEnd; p = next_[p])
            if ((places[p] - position).norm() <= tolerance_) return p;
        }
    const auto place = static_cast<uint32_t>(places.size());
    places.push_back(position);
    const auto own = scaled.floor().eval();
    uint32_t& newest = first_[slot(own.x(), own.y(), own.z())];
    next_.push_back(newest);
    newest = place;
    return place;
  }

 private:
  static constexpr uint32_t kEnd = Id<Mesh>::kNone;

  /// Where the list of a cell's places starts; cells may share a list.
  size_t slot(double x, double y, double z) const {
    uint64_t hash = 0;
    for (const double v : {x, y, z})
      hash = (hash ^ static_cast<uint64_t>(static_cast<int64_t>(v))) * 0x9e3779b97f4a7c15ull,
      hash ^= hash >> 32;
    return hash & (first_.size() - 1);
  }

  Vec3 low_;
  double tolerance_, cell_;
  std::vector<uint32_t> first_, next_;  // lists of places: per slot, per place
};

}  // namespace

Mesh weld(const Mesh& mesh, double relative_tolerance) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  Mesh welded;
  if (mesh.triangles.empty() || box.isEmpty() || !(box.diagonal().norm() > 0)) return welded;

  PlaceGrid grid(box.min(), relative_tolerance * box.diagonal().norm(), mesh.positions.size());
  std::vector<uint32_t> place(mesh.positions.size(), Id<Mesh>::kNone);
  for (const Triangle& triangle : mesh.triangles) {
    Triangle moved;
    for (int k = 0; k < 3; ++k) {
      uint32_t& target = place[triangle[k]];
      if (target == Id<Mesh>::kNone) target = grid.find_or_add(mesh.positions[triangle[k]], welded.positions);
      moved[k] = target;
    }
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
      welded.triangles.push_back(moved);
  }
  return compacted(welded);
}

std::vector<uint32_t> find_places(const std::vector<Vec3>& positions, double tolerance,
                                  std::vector<Vec3>& places) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : positions) box.extend(p);
  places.clear();
  std::vector<uint32_t> place(positions.size(), 0);
  if (positions.empty()) return place;
  PlaceGrid grid(box.min(), std::max(tolerance, 1e-300), positions.size());
  for (size_t i = 0; i < positions.size(); ++i) place[i] = grid.find_or_add(positions[i], places);
  return place;
}

Mesh compacted(const Mesh& mesh) {
  Mesh result;
  result.triangles.reserve(mesh.triangles.size());
  std::vector<uint32_t> place(mesh.positions.size(), Id<Mesh>::kNone);
  for (const Triangle& triangle : mesh.triangles) {
    Triangle moved;
    for (int k = 0; k < 3; ++k) {
      uint32_t& target = place[triangle[k]];
      if (target == Id<Mesh>::kNone) {
        target = static_cast<uint32_t>(result.positions.size());
        result.positions.push_back(mesh.positions[triangle[k]]);
      }
      moved[k] = target;
    }
    result.triangles.push_back(moved);
  }
  return result;
}

}  // namespace liana
