#include "mesher/solids/skins/cut_finder.h"

#include <algorithm>

#include "mesher/solids/sections/slice.h"

namespace liana {

std::optional<LevelLoop> CutFinder::find(const BranchAxis& axis) {
  const std::vector<uint32_t> way = way_down(field_, axis.tip);
  const double f = axis.base, rise = field_.distance[axis.tip] - f, d = axis.diameter;
  const auto level = [&](double height) {
    return loop_across(field_, way, f, [&, height](uint32_t u) { return field_.distance[u] - f - height; });
  };
  const auto near = level(std::min(0.3 * d, 0.2 * rise)), far = level(std::min(1.3 * d, 0.8 * rise));
  if (near && far) {
    const Vec3 from = polygon_moments(polygon_of(*near)).centroid,
               to = polygon_moments(polygon_of(*far)).centroid, along = (to - from).normalized();
    const double crotch = (field_.mesh.positions[axis.crotch] - from).dot(along);
    for (int step = 1; step <= 24; ++step) {
      const double place = crotch + 0.05 * step * d;
      if (place > (to - from).norm()) break;
      // Around a branch that stands off at right angles f begins below that of the crotch, by its diameter.
      const double lowest = f - 1.2 * d;
      const auto loop = loop_across(field_, way, lowest, [&](uint32_t u) {
        return (field_.mesh.positions[u] - from).dot(along) - place;
      });
      if (loop && accept(*loop, lowest, d)) return loop;
    }
  }
  for (const double height : {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
    const auto loop = level(std::min(height * d, 0.8 * height * rise));
    if (loop && accept(*loop, f, d)) return loop;
  }
  return {};
}

bool CutFinder::accept(const LevelLoop& loop, double base, double diameter) {
  if (perimeter(loop) > 1.6 * kPi * diameter) return false;
  for (const EdgeCrossing& c : loop) {
    const Vec3 &low = field_.mesh.positions[c.below], &high = field_.mesh.positions[c.above];
    const double part = (c.point - low).norm() / (high - low).norm();
    const double f = (1 - part) * field_.distance[c.below] + part * field_.distance[c.above];
    if (f < base || taken_[c.triangle]) return false;
  }
  for (const EdgeCrossing& c : loop) taken_[c.triangle] = 1;
  return true;
}

}  // namespace liana
