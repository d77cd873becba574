#include "mesher/surface/clearance.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/mesh_checks.h"

namespace liana {
namespace {

/// Of the mesh's extent: dot products with unit vectors are off by less than kRounding, triangles that part
/// by kMargin do not meet, and none is lower than kHeight. kAngle (rad) is larger than kRounding / kHeight.
constexpr double kRounding = 1e-14, kMargin = 1e-11, kHeight = 1e-7, kAngle = 1e-6;

/// Every vertex has one fan of triangles around it.
bool has_single_fans(const Mesh& mesh, const Adjacency& adjacency) {
  std::vector<uint32_t> corners(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) ++corners[v];
  const auto corner_of = [&](uint32_t triangle, uint32_t vertex) {
    const Triangle& t = mesh.triangles[triangle];
    return t[0] == vertex ? 0u : t[1] == vertex ? 1u : 2u;
  };
  std::vector<uint8_t> seen(mesh.positions.size(), 0);
  for (uint32_t start = 0; start < mesh.triangles.size(); ++start)
    for (const uint32_t vertex : mesh.triangles[start]) {
      if (seen[vertex]) continue;
      seen[vertex] = 1;
      uint32_t found = 1;
      for (const uint32_t edge : {2u, 0u}) {  // the edge into the corner, then the one out of it
        uint32_t t = start;
        do {
          t = adjacency.across[t][(corner_of(t, vertex) + edge) % 3];
          found += t != Adjacency::kNone && t != start;
        } while (t != Adjacency::kNone && t != start && found <= corners[vertex]);
        if (t == start) break;
      }
      if (found != corners[vertex]) return false;
    }
  return true;
}

/// A triangle with its box; corners in the order of the mesh.
struct Face {
  std::array<Vec3, 3> corner, edge;  // edge k runs from corner k
  Vec3 normal;                       // unit
  Eigen::AlignedBox3d box;
  Triangle vertices;
  double longest = 0, height = 0;  // m, height above the longest edge
};

class ClearanceProof {
 public:
  explicit ClearanceProof(const Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Triangle& t : mesh.triangles)
      for (const uint32_t v : t) box.extend(mesh.positions[v]);
    box.sizes().maxCoeff(&axis_);
    const double extent = box.sizes().maxCoeff();
    margin_ = kMargin * extent, rounding_ = kRounding * extent;
    faces_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      Face& face = faces_.emplace_back();
      face.vertices = t;
      for (int k = 0; k < 3; ++k) {
        face.corner[k] = mesh.positions[t[k]];
        face.edge[k] = mesh.positions[t[(k + 1) % 3]] - face.corner[k];
        face.box.extend(face.corner[k]);
        face.longest = std::max(face.longest, face.edge[k].norm());
      }
      face.normal = face.edge[0].cross(face.edge[1]);
      const double twice_area = face.normal.norm();
      face.height = twice_area / face.longest;
      flat_ |= !(face.height > kHeight * extent);
      face.normal /= twice_area;
    }
  }

  bool holds() {
    if (flat_) return false;
    std::sort(faces_.begin(), faces_.end(),
              [&](const Face& a, const Face& b) { return a.box.min()[axis_] < b.box.min()[axis_]; });
    for (size_t i = 0; i < faces_.size(); ++i) {
      const Face& a = faces_[i];
      const Vec3 low = a.box.min().array() - 2 * margin_, high = a.box.max().array() + 2 * margin_;
      for (size_t k = i + 1; k < faces_.size() && faces_[k].box.min()[axis_] <= high[axis_]; ++k) {
        const Face& b = faces_[k];
        if ((b.box.min().array() > high.array()).any() || (b.box.max().array() < low.array()).any()) continue;
        if (!apart(a, b)) return false;
      }
    }
    return true;
  }

 private:
  bool apart(const Face& a, const Face& b) const {
    int count = 0, shared_a[3], shared_b[3];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (a.vertices[i] == b.vertices[k]) shared_a[count] = i, shared_b[count] = k, ++count;
    if (count == 2) return hinged(a, 3 - shared_a[0] - shared_a[1], b, 3 - shared_b[0] - shared_b[1]);
    if (count == 3) return false;
    const int pivot_a = count ? shared_a[0] : -1, pivot_b = count ? shared_b[0] : -1;
    const auto parts = [&](const Vec3& direction) {
      const double length = direction.norm();
      if (!(length > 0)) return false;
      const Vec3 unit = direction / length;
      return count ? parts_at_vertex(unit, a, pivot_a, b, pivot_b) : parts_free(unit, a, b);
    };
    if (parts(a.normal) || parts(b.normal)) return true;
    for (int i = 0; i < 3; ++i)
      if (parts(a.normal.cross(a.edge[i])) || parts(b.normal.cross(b.edge[i]))) return true;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (parts(a.edge[i].cross(b.edge[k]))) return true;
    return false;
  }

  /// Two triangles on one edge: not folded onto each other. `tip`: the corner off the edge.
  bool hinged(const Face& a, int tip_a, const Face& b, int tip_b) const {
    const Vec3& on_edge = a.corner[(tip_a + 1) % 3];
    const Vec3 to_b = b.corner[tip_b] - on_edge;
    const double sure = margin_ * a.longest / a.height;  // the normal's rounding grows as the triangle thins
    if (std::abs(a.normal.dot(to_b)) > sure) return true;
    const Vec3 inward = a.normal.cross(a.edge[(tip_a + 1) % 3]).normalized();
    return inward.dot(to_b) < -sure && inward.dot(a.corner[tip_a] - on_edge) > sure;
  }

  bool parts_free(const Vec3& unit, const Face& a, const Face& b) const {
    const Vec3& origin = a.corner[0];
    double a_low = 0, a_high = 0, b_low = INFINITY, b_high = -INFINITY;
    for (int k = 0; k < 3; ++k) {
      const double at_a = unit.dot(a.corner[k] - origin), at_b = unit.dot(b.corner[k] - origin);
      a_low = std::min(a_low, at_a), a_high = std::max(a_high, at_a);
      b_low = std::min(b_low, at_b), b_high = std::max(b_high, at_b);
    }
    return b_low - a_high > margin_ || a_low - b_high > margin_;
  }

  /// A plane across `unit` through the common vertex: one triangle rises from it by kAngle, the other does
  /// not dip through it by more than rounding, which is less of an angle on triangles of kHeight.
  bool parts_at_vertex(const Vec3& unit, const Face& a, int pivot_a, const Face& b, int pivot_b) const {
    const Vec3& pivot = a.corner[pivot_a];
    const double a1 = unit.dot(a.corner[(pivot_a + 1) % 3] - pivot),
                 a2 = unit.dot(a.corner[(pivot_a + 2) % 3] - pivot),
                 b1 = unit.dot(b.corner[(pivot_b + 1) % 3] - pivot),
                 b2 = unit.dot(b.corner[(pivot_b + 2) % 3] - pivot);
    const double rise_a = kAngle * a.longest, rise_b = kAngle * b.longest;
    const double a_low = std::min(a1, a2), a_high = std::max(a1, a2), b_low = std::min(b1, b2),
                 b_high = std::max(b1, b2);
    return (a_low > rise_a && b_high < rounding_) || (a_high < -rise_a && b_low > -rounding_) ||
           (b_low > rise_b && a_high < rounding_) || (b_high < -rise_b && a_low > -rounding_);
  }

  std::vector<Face> faces_;
  Eigen::Index axis_ = 0;
  double margin_ = 0, rounding_ = 0;  // m
  bool flat_ = false;
};

}  // namespace

bool surely_clear(const Mesh& mesh) {
  if (mesh.triangles.empty()) return false;
  for (const Triangle& t : mesh.triangles)
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  const Adjacency adjacency = find_adjacency(mesh);
  return adjacency.manifold && adjacency.oriented && has_single_fans(mesh, adjacency) &&
         ClearanceProof(mesh).holds();
}

}  // namespace liana
