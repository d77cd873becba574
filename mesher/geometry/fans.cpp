#include "mesher/geometry/fans.h"

#include <numeric>

#include "mesher/geometry/disjoint_sets.h"

namespace liana {

Fans separate_fans(const Mesh& mesh, const Adjacency& adjacency) {
  Fans fans{mesh.triangles, std::vector<uint32_t>(mesh.positions.size())};
  std::iota(fans.vertex.begin(), fans.vertex.end(), 0u);
  DisjointSets corners(3 * mesh.triangles.size());  // 3 t + k
  const auto corner = [&](uint32_t t, uint32_t v) {
    const Triangle& triangle = mesh.triangles[t];
    return 3 * t + (triangle[0] == v ? 0 : triangle[1] == v ? 1 : 2);
  };
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t other = adjacency.across[t][k];
      if (other == Adjacency::kNone || other < t) continue;
      for (const uint32_t end : {k, (k + 1) % 3})
        corners.unite(corner(other, mesh.triangles[t][end]), 3 * t + end);
    }
  // The representative of a set is its first corner: the first of all at a vertex keeps the number.
  std::vector<uint8_t> taken(mesh.positions.size(), 0);
  std::vector<uint32_t> fan_of(3 * mesh.triangles.size());
  for (uint32_t c = 0; c < fan_of.size(); ++c) {
    uint32_t& own = fans.triangles[c / 3][c % 3];
    const uint32_t first = corners.find(c), v = own;
    if (first == c && taken[v]) {
      own = static_cast<uint32_t>(fans.vertex.size());
      fans.vertex.push_back(v);
    } else if (first == c) {
      taken[v] = 1;
    } else {
      own = fan_of[first];
    }
    fan_of[c] = own;
  }
  return fans;
}

bool is_oriented_manifold(const Mesh& mesh) {
  for (const Triangle& t : mesh.triangles)
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  const Adjacency adjacency = find_adjacency(mesh);
  return adjacency.manifold && adjacency.oriented &&
         separate_fans(mesh, adjacency).vertex.size() == mesh.positions.size();
}

}  // namespace liana
