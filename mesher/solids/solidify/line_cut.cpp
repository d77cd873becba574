#include "mesher/solids/solidify/line_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "mesher/geometry/edge_key.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/split_triangle.h"

namespace liana {
namespace {

constexpr double kFlat = 1e-3;  // rad: faces that meet at less count as one flat face

class LineCut {
 public:
  LineCut(MarkedSurface& surface, double level, double snap) : surface_(surface), level_(level) {
    side_.reserve(surface.distance.size());
    for (const double d : surface.distance)
      side_.push_back(std::abs(d - level) <= snap ? 0 : d < level ? -1 : 1);
  }

  void run() {
    const size_t count = surface_.mesh.triangles.size();
    for (size_t i = 0; i < count; ++i) split(i);
    for (const Point& point : points_)
      if (point.sides == 2 && point.turn < kFlat) remove(point.vertex);
    if (removed_) drop_dead();
  }

 private:
  struct Point {
    uint32_t vertex;
    int sides = 0;               ///< triangles that share the edge it lies on
    Vec3 normal = Vec3::Zero();  ///< of the first of them
    double turn = 0;             ///< rad, between the two
  };

  void split(size_t index) {
    const Triangle t = surface_.mesh.triangles[index];
    const std::array<int, 3> side{side_[t[0]], side_[t[1]], side_[t[2]]};
    const auto [lowest, highest] = std::minmax_element(side.begin(), side.end());
    if (*lowest >= 0 || *highest <= 0) return;
    const Vec3 normal = area_vector(surface_.mesh, t).normalized();
    const std::vector<Vec3>& at = surface_.mesh.positions;
    // By a margin, so that the copies of a symmetric leaf are cut alike whatever the last bits say.
    const auto shorter = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
      return (at[a] - at[b]).squaredNorm() <= 1.001 * (at[c] - at[d]).squaredNorm();
    };
    bool first = true;
    split_triangle(
        t, side, [&](uint32_t a, uint32_t b) { return point_between(a, b, normal); }, shorter,
        [&](const Triangle& part, int) {
          first ? replace(index, part) : add(index, part);
          first = false;
        });
  }

  uint32_t point_between(uint32_t a, uint32_t b, const Vec3& normal) {
    if (a > b) std::swap(a, b);  // the same point from both triangles, to the last bit
    const auto [it, is_new] = on_edge_.try_emplace(edge_key(a, b), points_.size());
    if (is_new) {
      const double da = surface_.distance[a], db = surface_.distance[b];
      const double f = (level_ - da) / (db - da);
      const Vec3 position =
          surface_.mesh.positions[a] + f * (surface_.mesh.positions[b] - surface_.mesh.positions[a]);
      points_.push_back({.vertex = static_cast<uint32_t>(surface_.mesh.positions.size())});
      surface_.mesh.positions.push_back(position);
      surface_.distance.push_back(level_);
      side_.push_back(0);
    }
    Point& point = points_[it->second];
    if (++point.sides == 1)
      point.normal = normal;
    else
      point.turn = std::asin(std::min(1.0, point.normal.cross(normal).norm()));
    return point.vertex;
  }

  void replace(size_t index, const Triangle& triangle) {
    surface_.mesh.triangles[index] = triangle;
    touched_.push_back(index);
  }
  void add(size_t index, const Triangle& triangle) {
    touched_.push_back(surface_.mesh.triangles.size());
    surface_.mesh.triangles.push_back(triangle);
    const uint8_t mark = surface_.is_root[index];
    surface_.is_root.push_back(mark);
  }

  bool dead(size_t i) const { return surface_.mesh.triangles[i][0] == surface_.mesh.triangles[i][1]; }

  /// Pulls a vertex inside a flat face onto a neighbour on the line, if no triangle turns over or gets thin
  /// by it.
  void remove(uint32_t vertex) {
    std::vector<size_t> around;
    for (const size_t i : touched_) {
      const Triangle& t = surface_.mesh.triangles[i];
      if (!dead(i) && std::find(t.begin(), t.end(), vertex) != t.end()) around.push_back(i);
    }
    std::vector<uint32_t> targets;
    for (const size_t i : around)
      for (const uint32_t v : surface_.mesh.triangles[i])
        if (v != vertex && side_[v] == 0 && std::find(targets.begin(), targets.end(), v) == targets.end())
          targets.push_back(v);
    uint32_t best = Adjacency::kNone;
    double best_shape = 0;
    for (const uint32_t target : targets) {
      const double shape = worst_shape_after(around, vertex, target);
      if (shape > 1.001 * best_shape) {
        best_shape = shape;
        best = target;
      }
    }
    if (best == Adjacency::kNone) return;
    for (const size_t i : around) {
      Triangle& t = surface_.mesh.triangles[i];
      if (std::find(t.begin(), t.end(), best) != t.end())
        t = {0, 0, 0};
      else
        *std::find(t.begin(), t.end(), vertex) = best;
    }
    removed_ = true;
  }

  /// Least height over longest side of the triangles that would remain; 0 if the collapse is not allowed.
  double worst_shape_after(const std::vector<size_t>& around, uint32_t vertex, uint32_t target) const {
    double worst = 1;
    int vanish = 0;
    for (const size_t i : around) {
      Triangle t = surface_.mesh.triangles[i];
      if (std::find(t.begin(), t.end(), target) != t.end()) {
        ++vanish;
        continue;
      }
      const Vec3 before = area_vector(surface_.mesh, t);
      *std::find(t.begin(), t.end(), vertex) = target;
      const Vec3 after = area_vector(surface_.mesh, t);
      if (!(after.dot(before) > 0) || after.cross(before).norm() > kFlat * after.norm() * before.norm())
        return 0;
      double longest = 0;
      for (int k = 0; k < 3; ++k)
        longest = std::max(
            longest, (surface_.mesh.positions[t[k]] - surface_.mesh.positions[t[(k + 1) % 3]]).squaredNorm());
      worst = std::min(worst, 2 * after.norm() / longest);
    }
    return vanish == 2 ? worst : 0;
  }

  void drop_dead() {
    size_t kept = 0;
    for (size_t i = 0; i < surface_.mesh.triangles.size(); ++i) {
      if (dead(i)) continue;
      surface_.mesh.triangles[kept] = surface_.mesh.triangles[i];
      surface_.is_root[kept++] = surface_.is_root[i];
    }
    surface_.mesh.triangles.resize(kept);
    surface_.is_root.resize(kept);
  }

  MarkedSurface& surface_;
  double level_;
  std::vector<int> side_;  // of the line, per vertex: -1 nearer the root, 0 on it, 1 beyond
  std::unordered_map<uint64_t, size_t> on_edge_;
  std::vector<Point> points_;
  std::vector<size_t> touched_;  // triangles made by this cut
  bool removed_ = false;
};

}  // namespace

void cut_along(MarkedSurface& surface, double level, double snap) {
  LineCut(surface, level, snap).run();
}

}  // namespace liana
