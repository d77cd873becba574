#include "mesher/surface/grade.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace liana {
namespace {

constexpr double kSnap = 0.25;      // of the ring spacing: nearer vertices count as on the line
constexpr double kTolerated = 1.3;  // a triangle may be this much longer than the spacing

/// True if a triangle that crosses the level is longer (along the distance) than the rings should be apart.
bool needs_line(const MarkedSurface& surface, double level, double spacing) {
  for (const Triangle& t : surface.mesh.triangles) {
    const double a = surface.distance[t[0]], b = surface.distance[t[1]], c = surface.distance[t[2]];
    const double low = std::min({a, b, c}), high = std::max({a, b, c});
    if (low < level - kSnap * spacing && high > level + kSnap * spacing && high - low > kTolerated * spacing)
      return true;
  }
  return false;
}

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
  }

 private:
  void split(size_t index) {
    const Triangle t = surface_.mesh.triangles[index];
    const int below = (side_[t[0]] < 0) + (side_[t[1]] < 0) + (side_[t[2]] < 0);
    const int above = (side_[t[0]] > 0) + (side_[t[1]] > 0) + (side_[t[2]] > 0);
    if (below == 0 || above == 0) return;
    if (below + above == 2) {  // one corner on the line: cut from it to the opposite edge
      const int k = side_[t[0]] == 0 ? 0 : side_[t[1]] == 0 ? 1 : 2;
      const uint32_t o = t[k], p = t[(k + 1) % 3], q = t[(k + 2) % 3], m = point_between(p, q);
      replace(index, {o, p, m});
      add(index, {o, m, q});
      return;
    }
    // One corner alone on its side: a triangle there and a quadrangle, which is halved along its shorter
    // diagonal.
    const int lone = below == 1 ? -1 : 1;
    const int k = side_[t[0]] == lone ? 0 : side_[t[1]] == lone ? 1 : 2;
    const uint32_t o = t[k], p = t[(k + 1) % 3], q = t[(k + 2) % 3];
    const uint32_t m = point_between(o, p), n = point_between(o, q);
    replace(index, {o, m, n});
    const std::vector<Vec3>& at = surface_.mesh.positions;
    if ((at[m] - at[q]).squaredNorm() <= 1.001 * (at[n] - at[p]).squaredNorm()) {
      add(index, {m, p, q});
      add(index, {m, q, n});
    } else {
      add(index, {m, p, n});
      add(index, {p, q, n});
    }
  }

  uint32_t point_between(uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);  // the same point from both triangles, to the last bit
    const auto [it, is_new] =
        points_.try_emplace(uint64_t{a} << 32 | b, static_cast<uint32_t>(surface_.mesh.positions.size()));
    if (is_new) {
      const double da = surface_.distance[a], db = surface_.distance[b];
      const double f = (level_ - da) / (db - da);
      const Vec3 point =
          surface_.mesh.positions[a] + f * (surface_.mesh.positions[b] - surface_.mesh.positions[a]);
      surface_.mesh.positions.push_back(point);
      surface_.distance.push_back(level_);
      side_.push_back(0);
    }
    return it->second;
  }

  void replace(size_t index, const Triangle& triangle) { surface_.mesh.triangles[index] = triangle; }
  void add(size_t index, const Triangle& triangle) {
    surface_.mesh.triangles.push_back(triangle);
    const uint8_t mark = surface_.is_root[index];
    surface_.is_root.push_back(mark);
  }

  MarkedSurface& surface_;
  double level_;
  std::vector<int> side_;  // of the line, per vertex: -1 nearer the root, 0 on it, 1 beyond
  std::unordered_map<uint64_t, uint32_t> points_;
};

}  // namespace

std::vector<double> ring_levels(double length, double diameter) {
  const double largest = length / 6;
  std::vector<double> levels;
  double at = 0;
  for (double step = diameter / 2; step < largest && at + step < length - largest / 2; step *= 2) {
    at += step;
    levels.push_back(at);
  }
  const int steps = std::max(1, static_cast<int>(std::ceil((length - at) / largest - 1e-9)));
  for (int i = 1; i < steps; ++i) levels.push_back(at + (length - at) * i / steps);
  return levels;
}

int grade(MarkedSurface& surface, double length, double diameter) {
  const std::vector<double> levels = ring_levels(length, diameter);
  int lines = 0;
  for (size_t i = 0; i < levels.size(); ++i) {
    const double before = levels[i] - (i ? levels[i - 1] : 0);
    const double after = (i + 1 < levels.size() ? levels[i + 1] : length) - levels[i];
    if (!needs_line(surface, levels[i], std::min(before, after))) continue;
    LineCut(surface, levels[i], kSnap * std::min(before, after)).run();
    ++lines;
  }
  return lines;
}

}  // namespace liana
