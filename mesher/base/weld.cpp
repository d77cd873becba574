#include "mesher/base/weld.h"

#include <cmath>
#include <unordered_map>

namespace liana {
namespace {

/// Finds the place near a position: a grid whose cells are larger than the tolerance, so that a position
/// mostly looks into one cell, and into its neighbours when it lies within the tolerance of the cell's side.
/// Not so large that many places could crowd into one cell.
class PlaceGrid {
 public:
  PlaceGrid(const Vec3& low, double tolerance) : low_(low), tolerance_(tolerance), cell_(16 * tolerance) {}

  /// Index of the place within the tolerance; a new one at the end of `places` if there is none.
  uint32_t find_or_add(const Vec3& position, std::vector<Vec3>& places) {
    const Eigen::Array3d scaled = (position - low_).array() / cell_;
    const Eigen::Array3d reach = Eigen::Array3d::Constant(tolerance_ / cell_);
    const auto first = (scaled - reach).floor().eval(), last = (scaled + reach).floor().eval();
    for (double x = first.x(); x <= last.x(); ++x)
      for (double y = first.y(); y <= last.y(); ++y)
        for (double z = first.z(); z <= last.z(); ++z) {
          const auto [begin, end] = cells_.equal_range(key(x, y, z));
          for (auto it = begin; it != end; ++it)
            if ((places[it->second] - position).norm() <= tolerance_) return it->second;
        }
    const auto place = static_cast<uint32_t>(places.size());
    places.push_back(position);
    const auto own = scaled.floor().eval();
    cells_.emplace(key(own.x(), own.y(), own.z()), place);
    return place;
  }

 private:
  static uint64_t key(double x, double y, double z) {
    const auto part = [](double v) { return static_cast<uint64_t>(static_cast<int64_t>(v)) & 0x1fffff; };
    return part(x) << 42 | part(y) << 21 | part(z);
  }

  Vec3 low_;
  double tolerance_, cell_;
  std::unordered_multimap<uint64_t, uint32_t> cells_;
};

}  // namespace

Mesh weld(const Mesh& mesh, double relative_tolerance) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  Mesh welded;
  if (mesh.triangles.empty() || box.isEmpty() || !(box.diagonal().norm() > 0)) return welded;

  PlaceGrid grid(box.min(), relative_tolerance * box.diagonal().norm());
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
  PlaceGrid grid(box.min(), std::max(tolerance, 1e-300));
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
