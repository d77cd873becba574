#include "mesher/solids/skins/level_loop.h"

namespace liana {

std::optional<LevelLoop> trace_loop(const Mesh& mesh, const Adjacency& adjacency, const VertexValue& value,
                                    uint32_t below, uint32_t above, uint32_t triangle) {
  LevelLoop loop;
  uint32_t from = below, to = above, at = triangle;
  const size_t limit = mesh.triangles.size() + 1;
  do {
    const double low = value(from), high = value(to);
    const double f = high > low ? -low / (high - low) : 0.5;
    loop.push_back({from, to, at, mesh.positions[from] + f * (mesh.positions[to] - mesh.positions[from])});
    // The third corner decides which of its two other edges the line leaves by.
    const Triangle& t = mesh.triangles[at];
    uint32_t k = 0;
    while (k < 3 && (t[k] == from || t[k] == to)) ++k;
    if (k == 3) return {};
    const uint32_t third = t[k];
    (value(third) < 0 ? from : to) = third;
    uint32_t edge = 0;
    while (!((t[edge] == from && t[(edge + 1) % 3] == to) || (t[edge] == to && t[(edge + 1) % 3] == from)))
      ++edge;
    at = adjacency.across[at][edge];
    if (at == Adjacency::kNone || loop.size() > limit) return {};
  } while (from != below || to != above);
  if (loop.size() < 3) return {};
  return loop;
}

std::vector<Vec3> polygon_of(const LevelLoop& loop) {
  std::vector<Vec3> polygon;
  polygon.reserve(loop.size());
  for (const EdgeCrossing& crossing : loop) polygon.push_back(crossing.point);
  return polygon;
}

double perimeter(const LevelLoop& loop) {
  double sum = 0;
  for (size_t i = 0; i < loop.size(); ++i) sum += (loop[(i + 1) % loop.size()].point - loop[i].point).norm();
  return sum;
}

}  // namespace liana
