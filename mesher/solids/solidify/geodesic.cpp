#include "mesher/solids/solidify/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "mesher/geometry/mesh_checks.h"

namespace liana {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Marches the distance over the triangles in the order of distance (as fast marching does), then relaxes
/// until nothing changes, because in obtuse triangles a vertex may depend on a later one.
class Front {
 public:
  Front(const Mesh& mesh, const std::vector<uint8_t>& is_source)
      : mesh_(mesh), distance_(mesh.positions.size(), kFar), origin_(mesh.positions), around_(mesh) {
    for (size_t v = 0; v < distance_.size(); ++v)
      if (is_source[v]) distance_[v] = 0;
  }

  std::vector<double> run() {
    march();
    for (int sweep = 0; sweep < 20; ++sweep) {
      double change = 0, largest = 0;
      for (const Triangle& t : mesh_.triangles) change = std::max(change, relax(t));
      for (const double d : distance_) largest = std::max(largest, d == kFar ? 0 : d);
      if (change <= 1e-6 * largest) break;
    }
    return std::move(distance_);
  }

 private:
  void march() {
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (uint32_t v = 0; v < distance_.size(); ++v)
      if (distance_[v] == 0) queue.push({0, v});
    while (!queue.empty()) {
      const auto [distance, vertex] = queue.top();
      queue.pop();
      if (distance > distance_[vertex]) continue;
      for (const uint32_t i : around_.of(vertex)) {
        const Triangle& t = mesh_.triangles[i];
        const std::array<double, 3> before = {distance_[t[0]], distance_[t[1]], distance_[t[2]]};
        relax(t);
        for (int k = 0; k < 3; ++k)
          if (distance_[t[k]] < before[k]) queue.push({distance_[t[k]], t[k]});
      }
    }
  }

  /// Updates each corner from the two others; returns the largest change (0 if a corner was unreached
  /// before).
  double relax(const Triangle& t) {
    double change = 0;
    for (int k = 0; k < 3; ++k) change = std::max(change, update(t[k], t[(k + 1) % 3], t[(k + 2) % 3]));
    return change;
  }

  double update(uint32_t a, uint32_t b, uint32_t c) {
    const double before = distance_[c];
    const Vec3 ab = mesh_.positions[b] - mesh_.positions[a], ac = mesh_.positions[c] - mesh_.positions[a];
    offer(c, distance_[a] + ac.norm(), origin_[a]);
    offer(c, distance_[b] + (ac - ab).norm(), origin_[b]);
    if (distance_[a] != kFar && distance_[b] != kFar) across_edge(a, b, c, ab, ac);
    return before == kFar ? 0 : before - distance_[c];
  }

  /// The front crosses the edge ab on its way to c. In the plane of the triangle a = (0, 0), b = (e, 0), c =
  /// (x, y).
  void across_edge(uint32_t a, uint32_t b, uint32_t c, const Vec3& ab, const Vec3& ac) {
    const double e = ab.norm(), x = ac.dot(ab) / e, y = ab.cross(ac).norm() / e;
    const double da = distance_[a], db = distance_[b];
    // A straight front: its direction (gx, gy) follows from the difference along the edge.
    const double gx = (db - da) / e;
    if (!(std::abs(gx) < 1) || !(y > 0)) return;
    const double gy = std::sqrt(1 - gx * gx);
    double reached = da + gx * x + gy * y, crossing = x - gx / gy * y;
    // A circular front: around the point (sx, -sy) with the right distances to a and b.
    const double sx = (da * da - db * db + e * e) / (2 * e), square = da * da - sx * sx;
    const double spread =
        (origin_[b] - origin_[a]).norm() / (e * gy);  // 0 for one source, 1 for a straight front
    if (square > 0 && spread < 1) {
      const double sy = std::sqrt(square);
      const double circular = std::hypot(x - sx, y + sy), through = sx + (x - sx) * sy / (sy + y);
      reached = spread * reached + (1 - spread) * circular;
      crossing = spread * crossing + (1 - spread) * through;
    }
    if (crossing < 0 || crossing > e || reached < std::min(da, db)) return;
    offer(c, reached, origin_[a] + crossing / e * (origin_[b] - origin_[a]));
  }

  void offer(uint32_t vertex, double distance, const Vec3& origin) {
    if (distance < distance_[vertex]) {
      distance_[vertex] = distance;
      origin_[vertex] = origin;
    }
  }

  const Mesh& mesh_;
  std::vector<double> distance_;
  std::vector<Vec3> origin_;  // where on the sources the path to a vertex begins
  VertexTriangles around_;
};

}  // namespace

std::vector<double> geodesic_distance(const Mesh& mesh, const std::vector<uint8_t>& is_source) {
  return Front(mesh, is_source).run();
}

}  // namespace liana
