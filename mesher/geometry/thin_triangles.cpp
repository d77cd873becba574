#include "mesher/geometry/thin_triangles.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"

namespace liana {
namespace {

constexpr int kRounds = 20;
constexpr double kTurned = 0.5;  // cosine of the angle between normals before and after

class Thinning {
 public:
  Thinning(const Mesh& mesh, double least) : mesh_(mesh), least_(least), around_(mesh.positions.size()) {
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      for (const uint32_t v : mesh_.triangles[i]) around_[v].push_back(i);
    alive_.assign(mesh_.triangles.size(), 1);
  }

  Mesh run() {
    bool changed = true;
    for (int round = 0; changed && round < kRounds; ++round) {
      changed = false;
      for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
        if (alive_[i] && improve(i)) changed = true;
    }
    Mesh kept{mesh_.positions, {}};
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (alive_[i]) kept.triangles.push_back(mesh_.triangles[i]);
    return compacted(kept);
  }

 private:
  const Vec3& at(uint32_t v) const { return mesh_.positions[v]; }

  double height(const Triangle& t) const {
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (at(t[k]) - at(t[(k + 1) % 3])).norm());
    return longest > 0 ? 2 * area_vector(mesh_, t).norm() / longest : 0;
  }

  bool improve(uint32_t i) {
    const Triangle t = mesh_.triangles[i];
    std::array<double, 3> edge;  // from corner k to the next
    for (int k = 0; k < 3; ++k) edge[k] = (at(t[k]) - at(t[(k + 1) % 3])).norm();
    const auto shortest = static_cast<int>(std::min_element(edge.begin(), edge.end()) - edge.begin());
    const auto longest = static_cast<int>(std::max_element(edge.begin(), edge.end()) - edge.begin());
    if (edge[shortest] < least_) {
      const uint32_t a = t[shortest], b = t[(shortest + 1) % 3];
      if (collapse(a, b) || collapse(b, a)) return true;
    }
    if (height(t) >= least_) return false;
    return flip(i, t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]);
  }

  /// Neither may be turned over; what is thin has no direction to keep.
  bool keeps_direction(const Triangle& before, const Triangle& after) const {
    if (height(before) < least_) return true;
    const Vec3 m = area_vector(mesh_, before), n = area_vector(mesh_, after);
    return m.dot(n) > kTurned * m.norm() * n.norm();
  }

  std::vector<uint32_t> neighbours(uint32_t v) const {
    std::vector<uint32_t> all;
    for (const uint32_t i : around_[v])
      for (const uint32_t w : mesh_.triangles[i])
        if (w != v) all.push_back(w);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  static bool has(const Triangle& t, uint32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); }

  /// `gone` moves to `kept`.
  bool collapse(uint32_t gone, uint32_t kept) {
    std::vector<uint32_t> common;
    const std::vector<uint32_t> a = neighbours(gone), b = neighbours(kept);
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != 2 || a.size() + b.size() < 7) return false;  // or a tetrahedron would fold up
    for (const uint32_t i : around_[gone]) {
      const Triangle& before = mesh_.triangles[i];
      if (has(before, kept)) continue;
      Triangle after = before;
      std::replace(after.begin(), after.end(), gone, kept);
      if (!keeps_direction(before, after)) return false;
      if (height(after) < std::min(least_, height(before)) / 2) return false;
    }
    for (const uint32_t i : std::vector<uint32_t>(around_[gone])) {
      Triangle& t = mesh_.triangles[i];
      if (has(t, kept)) {
        alive_[i] = 0;
        for (const uint32_t v : t) std::erase(around_[v], i);
      } else {
        std::replace(t.begin(), t.end(), gone, kept);
        around_[kept].push_back(i);
      }
    }
    around_[gone].clear();
    return true;
  }

  /// The edge ab of the cap i = (a, b, c) becomes the edge from c to the corner d across.
  bool flip(uint32_t i, uint32_t a, uint32_t b, uint32_t c) {
    for (const uint32_t j : around_[a]) {
      const Triangle across = mesh_.triangles[j];
      if (j == i || !has(across, b)) continue;
      uint32_t d = c;
      for (const uint32_t v : across)
        if (v != a && v != b) d = v;
      const std::vector<uint32_t> beside = neighbours(c);
      if (d == c || std::binary_search(beside.begin(), beside.end(), d)) return false;
      const Triangle first{a, d, c}, second{d, b, c};
      if (std::min(height(first), height(second)) <= height(mesh_.triangles[i])) return false;
      for (const Triangle& t : {first, second})
        if (!keeps_direction(across, t)) return false;
      mesh_.triangles[i] = first, mesh_.triangles[j] = second;
      std::erase(around_[b], i), std::erase(around_[a], j);
      around_[d].push_back(i), around_[c].push_back(j);
      return true;
    }
    return false;
  }

  Mesh mesh_;
  double least_;
  std::vector<std::vector<uint32_t>> around_;  // triangles of a vertex
  std::vector<uint8_t> alive_;
};

}  // namespace

Mesh without_thin_triangles(const Mesh& closed, double least) {
  return Thinning(closed, least).run();
}

}  // namespace liana
