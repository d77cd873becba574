#include "mesher/geometry/thin_triangles.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesher/geometry/half_edge.h"
#include "mesher/geometry/weld.h"

namespace liana {
namespace {

constexpr int kRounds = 20;
constexpr double kTurned = 0.5;  // cosine of the angle between normals before and after

class Thinning {
 public:
  Thinning(const Mesh& mesh, double least) : mesh_{mesh.positions, {}}, least_(least), edges_(mesh) {}

  Mesh run() {
    bool changed = true;
    for (int round = 0; changed && round < kRounds; ++round) {
      changed = false;
      for (uint32_t i = 0; i < edges_.triangle_count(); ++i)
        if (!edges_.removed(i) && improve(i)) changed = true;
    }
    return compacted({mesh_.positions, edges_.triangles()});
  }

 private:
  const Vec3& at(uint32_t v) const { return mesh_.positions[v]; }
  double length(HalfEdge h) const { return (at(edges_.from(h)) - at(edges_.to(h))).norm(); }
  Vec3 normal(const Triangle& t) const { return area_vector(mesh_, t); }
  double height(const Triangle& t) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (at(t[k]) - at(t[(k + 1) % 3])).norm());
    return longest > 0 ? 2 * normal(t).norm() / longest : 0;
  }

  bool improve(uint32_t i) {
    std::array<HalfEdge, 3> side;
    for (int k = 0; k < 3; ++k) side[k] = edges_.half_edge(i, k);
    const auto shorter = [&](HalfEdge a, HalfEdge b) { return length(a) < length(b); };
    const HalfEdge shortest = *std::min_element(side.begin(), side.end(), shorter),
                   longest = *std::max_element(side.begin(), side.end(), shorter);
    if (length(shortest) < least_ && (collapse(shortest) || collapse(edges_.opposite(shortest)))) return true;
    return height(edges_.corners(i)) < least_ && flip(longest);
  }

  /// Neither may be turned over; what is thin has no direction to keep.
  bool keeps_direction(const Triangle& before, const Triangle& after) const {
    if (height(before) < least_) return true;
    const Vec3 m = normal(before), n = normal(after);
    return m.dot(n) > kTurned * m.norm() * n.norm();
  }

  bool collapse(HalfEdge h) {
    const uint32_t gone = edges_.from(h), kept = edges_.to(h);
    for (const HalfEdge out : edges_.leaving(h)) {
      if (edges_.triangle(out) == HalfEdgeMesh::kNone) continue;
      const Triangle before = edges_.corners(edges_.triangle(out));
      if (std::find(before.begin(), before.end(), kept) != before.end()) continue;
      Triangle after = before;
      std::replace(after.begin(), after.end(), gone, kept);
      if (!keeps_direction(before, after)) return false;
      if (height(after) < std::min(least_, height(before)) / 2) return false;
    }
    return edges_.collapse(h);
  }

  /// The long edge ab of a cap (a, b, c) becomes the edge from c to the corner d across.
  bool flip(HalfEdge h) {
    const HalfEdge over = edges_.opposite(h);
    if (edges_.triangle(over) == HalfEdgeMesh::kNone) return false;
    const Triangle cap = edges_.corners(edges_.triangle(h)), across = edges_.corners(edges_.triangle(over));
    const uint32_t a = edges_.from(h), b = edges_.to(h), c = edges_.apex(h), d = edges_.apex(over);
    const Triangle first{a, d, c}, second{d, b, c};
    if (std::min(height(first), height(second)) <= height(cap)) return false;
    if (!keeps_direction(across, first) || !keeps_direction(across, second)) return false;
    return edges_.flip(h);
  }

  Mesh mesh_;  // its positions: what triangles it has, the half-edges know
  double least_;
  HalfEdgeMesh edges_;
};

}  // namespace

Mesh without_thin_triangles(const Mesh& closed, double least) {
  return Thinning(closed, least).run();
}

}  // namespace liana
