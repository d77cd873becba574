#include "mesher/solids/solidify/grade.h"

#include <algorithm>
#include <cmath>

#include "mesher/solids/solidify/line_cut.h"

namespace liana {
namespace {

constexpr double kSnap = 0.25;      // of the ring spacing: nearer vertices count as on the line
constexpr double kFinest = 1e-6;    // of the length, for a root pinched to a line
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

void drop_unused(MarkedSurface& surface) {
  std::vector<uint32_t> place(surface.mesh.positions.size(), Id<Mesh>::kNone);
  for (const Triangle& t : surface.mesh.triangles)
    for (const uint32_t v : t) place[v] = 0;
  uint32_t kept = 0;
  for (size_t v = 0; v < place.size(); ++v) {
    if (place[v] == Id<Mesh>::kNone) continue;
    surface.mesh.positions[kept] = surface.mesh.positions[v];
    surface.distance[kept] = surface.distance[v];
    place[v] = kept++;
  }
  surface.mesh.positions.resize(kept);
  surface.distance.resize(kept);
  for (Triangle& t : surface.mesh.triangles)
    for (uint32_t& v : t) v = place[v];
}

}  // namespace

std::vector<double> ring_levels(double length, double diameter) {
  if (!(length > 0) || !std::isfinite(length)) return {};
  const double largest = length / 6;
  std::vector<double> levels;
  double at = 0;
  for (double step = std::max(diameter / 2, kFinest * length);
       step < largest && at + step < length - largest / 2; step *= 2) {
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
    cut_along(surface, levels[i], kSnap * std::min(before, after));
    ++lines;
  }
  if (lines) drop_unused(surface);
  return lines;
}

}  // namespace liana
