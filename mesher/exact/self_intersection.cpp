#include "mesher/exact/self_intersection.h"

#define CGAL_NO_WARNINGS
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangle_3.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/fans.h"

namespace liana {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<const Vec3*, 3>;

Kernel::Point_3 exact(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// Sign of det(b - a, c - a, d - a), or 0 if rounding could have changed it. The bound is Shewchuk's (1997)
/// for the determinant of differences: (7 + 56 ε) ε times the permanent, taken as 8 ε.
int certain_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double xy = u.x() * v.y(), yx = u.y() * v.x(), yz = u.y() * v.z(), zy = u.z() * v.y(),
               zx = u.z() * v.x(), xz = u.x() * v.z();
  const double det = (yz - zy) * w.x() + (zx - xz) * w.y() + (xy - yx) * w.z();
  const double permanent = (std::abs(yz) + std::abs(zy)) * std::abs(w.x()) +
                           (std::abs(zx) + std::abs(xz)) * std::abs(w.y()) +
                           (std::abs(xy) + std::abs(yx)) * std::abs(w.z());
  const double bound = 8 * std::numeric_limits<double>::epsilon() * permanent + 1e-290;
  return det > bound ? 1 : det < -bound ? -1 : 0;
}

/// The same in the plane of two axes, for (b - a) × (c - a).
int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int x, int y) {
  const double left = (b[x] - a[x]) * (c[y] - a[y]), right = (b[y] - a[y]) * (c[x] - a[x]);
  const double bound =
      4 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right)) + 1e-290;
  return left - right > bound ? 1 : left - right < -bound ? -1 : 0;
}

class Intersections {
 public:
  explicit Intersections(const Mesh& mesh) : mesh_(mesh) {}

  bool any() const {
    const BoxTree tree(triangle_boxes(mesh_), 8);
    return tree.any_pair([this](uint32_t a, uint32_t b) { return meet(a, b); });
  }

 private:
  /// Whether two triangles have more in common than the vertices they share.
  bool meet(uint32_t first, uint32_t second) const {
    Triangle s = mesh_.triangles[first], t = mesh_.triangles[second];
    int shared = 0;  // moved to the front of both
    for (int i = shared; i < 3; ++i)
      for (int k = shared; k < 3; ++k)
        if (i >= shared && s[i] == t[k]) {
          std::swap(s[shared], s[i]), std::swap(t[shared], t[k]);
          ++shared;
          break;
        }
    if (shared == 3) return true;
    const Corners a = {&mesh_.positions[s[0]], &mesh_.positions[s[1]], &mesh_.positions[s[2]]},
                  b = {&mesh_.positions[t[0]], &mesh_.positions[t[1]], &mesh_.positions[t[2]]};
    if (apart_by_plane(a, b, shared) || apart_by_plane(b, a, shared)) return false;
    if (apart_by_edge(a, b, shared) || apart_by_edge(b, a, shared)) return false;
    return meet_exactly(a, b, shared);
  }

  /// All of b that is not shared lies strictly on one side of a's plane.
  static bool apart_by_plane(const Corners& a, const Corners& b, int shared) {
    const int side = certain_side(*a[0], *a[1], *a[2], *b[shared]);
    if (side == 0) return false;
    for (int k = shared + 1; k < 3; ++k)
      if (certain_side(*a[0], *a[1], *a[2], *b[k]) != side) return false;
    return true;
  }

  /// Seen along an axis, a line through an edge of a has a on one side and all of b that is not shared
  /// strictly on the other: in common are at most points of that line over b's shared corners.
  static bool apart_by_edge(const Corners& a, const Corners& b, int shared) {
    const Vec3 normal = (*a[1] - *a[0]).cross(*a[2] - *a[0]);
    int drop;
    normal.cwiseAbs().maxCoeff(&drop);
    const int x = (drop + 1) % 3, y = (drop + 2) % 3;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &from = *a[k], &to = *a[(k + 1) % 3], &opposite = *a[(k + 2) % 3];
      const int own = certain_turn(from, to, opposite, x, y);
      if (own == 0) return false;
      // Shared corners must be ends of this edge.
      if ((shared == 1 && k == 1) || (shared == 2 && k != 0)) continue;
      int outside = shared;
      while (outside < 3 && certain_turn(from, to, *b[outside], x, y) == -own) ++outside;
      if (outside == 3) return true;
    }
    return false;
  }

  static bool meet_exactly(const Corners& a, const Corners& b, int shared) {
    const Kernel::Point_3 a0 = exact(*a[0]), a1 = exact(*a[1]), a2 = exact(*a[2]), b0 = exact(*b[0]),
                          b1 = exact(*b[1]), b2 = exact(*b[2]);
    if (shared == 2)  // folded onto one another
      return CGAL::coplanar(a0, a1, a2, b2) && CGAL::coplanar_orientation(a0, a1, a2, b2) == CGAL::POSITIVE;
    const Kernel::Triangle_3 s(a0, a1, a2), t(b0, b1, b2);
    if (shared == 1)
      return CGAL::do_intersect(s, Kernel::Segment_3(b1, b2)) ||
             CGAL::do_intersect(t, Kernel::Segment_3(a1, a2));
    return CGAL::do_intersect(s, t);
  }

  const Mesh& mesh_;
};

bool has_flat_triangle(const Mesh& mesh) {
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.positions[i], &b = mesh.positions[j], &c = mesh.positions[k];
    if (certain_turn(a, b, c, 0, 1) || certain_turn(a, b, c, 1, 2) || certain_turn(a, b, c, 2, 0)) continue;
    if (CGAL::collinear(exact(a), exact(b), exact(c))) return true;
  }
  return false;
}

}  // namespace

bool self_intersects(const Mesh& mesh) {
  return !is_oriented_manifold(mesh) || has_flat_triangle(mesh) || Intersections(mesh).any();
}

}  // namespace liana
