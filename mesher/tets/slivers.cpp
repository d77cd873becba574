#include "mesher/tets/slivers.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace liana {
namespace {

using Face = std::array<uint32_t, 3>;

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

double volume_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return std::abs((b - a).cross(c - a).dot(d - a)) / 6;
}

class SliverRemoval {
 public:
  SliverRemoval(TetGenResult& mesh, double height, double volume)
      : mesh_(mesh), height_(height), volume_left_(volume) {
    for (const BoundaryFace& f : mesh.boundary) boundary_[sorted(f.corners)] = f.is_root;
  }

  bool run() {
    std::vector<uint32_t> slivers;
    for (uint32_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      if (least_height(at(a), at(b), at(c), at(d)) < height_) slivers.push_back(t);
    }
    if (slivers.empty()) return true;
    std::vector<uint8_t> removed(mesh_.tets.size(), 0);
    for (const uint32_t t : slivers) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      removed[t] = 1;
      volume_left_ -= volume_of(at(a), at(b), at(c), at(d));
    }
    if (volume_left_ < 0) return false;
    // Peeling one from the boundary may bring the next to it.
    while (std::erase_if(slivers, [&](uint32_t t) { return peel(mesh_.tets[t]); }) > 0) {
    }
    for (const uint32_t t : slivers)
      if (touches_root(mesh_.tets[t])) return false;
    size_t kept = 0;
    for (size_t t = 0; t < mesh_.tets.size(); ++t)
      if (!removed[t]) mesh_.tets[kept++] = mesh_.tets[t];
    mesh_.tets.resize(kept);
    mesh_.boundary.clear();
    for (const auto& [face, is_root] : boundary_) mesh_.boundary.push_back({face, is_root});
    return true;
  }

 private:
  const Vec3& at(uint32_t v) const { return mesh_.positions[v]; }

  bool has_boundary_edge(uint32_t a, uint32_t b) const {
    return std::any_of(boundary_.begin(), boundary_.end(), [&](const auto& entry) {
      const Face& f = entry.first;
      return std::count(f.begin(), f.end(), a) + std::count(f.begin(), f.end(), b) == 2;
    });
  }

  static Face opposite(const std::array<uint32_t, 4>& tet, int k) {
    return sorted({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]});
  }

  bool touches_root(const std::array<uint32_t, 4>& tet) const {
    for (int k = 0; k < 4; ++k) {
      const auto found = boundary_.find(opposite(tet, k));
      if (found != boundary_.end() && found->second) return true;
    }
    return false;
  }

  /// Moves the boundary to the other side of a tet that has two boundary faces of one kind.
  bool peel(const std::array<uint32_t, 4>& tet) {
    std::vector<Face> outer, inner;
    for (int k = 0; k < 4; ++k) {
      const Face face = opposite(tet, k);
      (boundary_.count(face) ? outer : inner).push_back(face);
    }
    if (outer.size() != 2 || boundary_[outer[0]] != boundary_[outer[1]]) return false;
    uint32_t diagonal[2];  // of the boundary to come: the edge shared by the inner faces
    std::set_intersection(inner[0].begin(), inner[0].end(), inner[1].begin(), inner[1].end(), diagonal);
    if (has_boundary_edge(diagonal[0], diagonal[1])) return false;
    const bool is_root = boundary_[outer[0]];
    for (const Face& face : outer) boundary_.erase(face);
    for (const Face& face : inner) boundary_[face] = is_root;
    return true;
  }

  TetGenResult& mesh_;
  double height_, volume_left_;
  std::map<Face, bool> boundary_;
};

}  // namespace

double least_height(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double area = std::max({(b - a).cross(c - a).norm(), (b - a).cross(d - a).norm(),
                                (c - a).cross(d - a).norm(), (c - b).cross(d - b).norm()}) /
                      2;
  return area > 0 ? 3 * volume_of(a, b, c, d) / area : 0;
}

bool remove_slivers(TetGenResult& mesh, double height, double volume) {
  return SliverRemoval(mesh, height, volume).run();
}

}  // namespace liana
