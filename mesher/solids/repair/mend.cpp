#include "mesher/solids/repair/mend.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesher/geometry/fans.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/repair/enclosed_volume.h"

namespace liana {
namespace {

constexpr double kSlit = 0.02;        // of the edge that a vertex is taken to lie on
constexpr double kSmallPatch = 0.12;  // of the area
constexpr size_t kMostBorder = 5000;  // border edges: each is compared with each vertex

struct BorderEdge {
  uint32_t triangle, edge;
};

/// Splits border triangles at border vertices that lie on their edge. Returns how many.
size_t close_slits(Mesh& mesh) {
  const Adjacency adjacency = find_adjacency(mesh);
  std::vector<BorderEdge> border;
  std::vector<uint32_t> vertices;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k)
      if (adjacency.across[t][k] == Adjacency::kNone) {
        border.push_back({t, k});
        vertices.push_back(mesh.triangles[t][k]);
        vertices.push_back(mesh.triangles[t][(k + 1) % 3]);
      }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (border.size() > kMostBorder) return 0;

  size_t split = 0;
  uint32_t last = Id<Mesh>::kNone;  // triangle that was split: one edge a triangle and pass
  for (const auto& [triangle, k] : border) {
    if (triangle == last) continue;
    const Triangle t = mesh.triangles[triangle];
    const uint32_t end = t[(k + 1) % 3], opposite = t[(k + 2) % 3];
    const Vec3 along = mesh.positions[end] - mesh.positions[t[k]];
    const double length = along.norm();
    std::vector<std::pair<double, uint32_t>> on_edge;  // place, vertex
    for (const uint32_t v : vertices) {
      if (v == t[0] || v == t[1] || v == t[2]) continue;
      const Vec3 from = mesh.positions[v] - mesh.positions[t[k]];
      const double place = from.dot(along) / (length * length);
      if (place < kSlit || place > 1 - kSlit || (from - place * along).norm() > kSlit * length) continue;
      on_edge.push_back({place, v});
    }
    if (on_edge.empty()) continue;
    std::sort(on_edge.begin(), on_edge.end());
    uint32_t from = t[k];
    for (const auto& [place, v] : on_edge) {
      mesh.triangles.push_back({from, v, opposite});
      from = v;
    }
    mesh.triangles[triangle] = {from, end, opposite};
    split += on_edge.size();
    last = triangle;
  }
  return split;
}

/// Removes the smallest patch (triangles connected over edges of two) at an edge of three or more triangles:
/// a wall across a tube is smaller than what it closes off. False if there is no such edge, or if the patch
/// is no small part of the whole.
bool drop_patch(Mesh& mesh, double& volume) {
  const Adjacency adjacency = find_adjacency(mesh);
  if (adjacency.manifold) return false;
  uint32_t count = 0;
  const std::vector<uint32_t> part = connected_parts(adjacency, &count);
  std::vector<double> area(count, 0), rim(count, 0);
  std::vector<uint8_t> at_joint(count, 0), has_border(count, 0);
  for (size_t i = 0; i < part.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    area[part[i]] += area_vector(mesh, t).norm();
    for (int k = 0; k < 3; ++k) {
      const bool crowded = adjacency.crowded[i][k];
      has_border[part[i]] |= !crowded && adjacency.across[i][k] == Adjacency::kNone;
      at_joint[part[i]] |= crowded;
      if (crowded) rim[part[i]] += (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm();
    }
  }
  // What stands on its rim like a twig, larger than anything flat within that rim, is no inner wall.
  const auto may_go = [&](uint32_t p) {
    return at_joint[p] && (has_border[p] || area[p] < 2 * rim[p] * rim[p] / (4 * kPi));
  };
  uint32_t smallest = count;
  for (uint32_t p = 0; p < count; ++p)
    if (may_go(p) && (smallest == count || area[p] < area[smallest])) smallest = p;
  if (smallest == count || area[smallest] > kSmallPatch * std::accumulate(area.begin(), area.end(), 0.0))
    return false;
  size_t kept = 0;
  Mesh patch{mesh.positions, {}};
  for (size_t i = 0; i < part.size(); ++i)
    (part[i] == smallest ? patch.triangles.emplace_back() : mesh.triangles[kept++]) = mesh.triangles[i];
  mesh.triangles.resize(kept);
  volume += enclosed_volume(patch);
  return true;
}

/// Gives every fan of triangles at a vertex a vertex of its own. Returns how many were added.
size_t part_pinches(Mesh& mesh) {
  Fans fans = separate_fans(mesh, find_adjacency(mesh));
  const size_t before = mesh.positions.size(), added = fans.vertex.size() - before;
  if (added == 0) return 0;
  mesh.triangles = std::move(fans.triangles);
  std::vector<uint8_t> moves(fans.vertex.size(), 0);
  for (size_t copy = before; copy < moves.size(); ++copy) {
    const uint32_t old = fans.vertex[copy];
    mesh.positions.push_back(mesh.positions[old]);
    moves[old] = moves[copy] = 1;
  }
  std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
  std::vector<int> count(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (moves[t[k]]) {
        sum[t[k]] += mesh.positions[t[(k + 1) % 3]] + mesh.positions[t[(k + 2) % 3]];
        count[t[k]] += 2;
      }
  for (size_t v = 0; v < moves.size(); ++v)
    if (moves[v] && count[v]) mesh.positions[v] += 1e-3 * (sum[v] / count[v] - mesh.positions[v]);
  return added;
}

}  // namespace

Mended mend(const Mesh& welded) {
  Mended result{welded, 0, 0, {}};
  Mesh& mesh = result.mesh;
  size_t slits = 0, patches = 0;
  for (int pass = 0; pass < 4; ++pass) {
    const size_t split = close_slits(mesh);
    if (split == 0) break;
    slits += split;
    mesh = weld(mesh);
  }
  const double area = surface_area(mesh);
  while (patches < 100 && drop_patch(mesh, result.dropped_volume)) ++patches;
  if (patches) result.dropped = 1 - surface_area(mesh) / area;
  const size_t pinches = part_pinches(mesh);
  if (slits) result.notes += fmt::format("+{}-slits-closed", slits);
  if (patches) result.notes += fmt::format("+{}-inner-or-loose-faces-dropped", patches);
  if (pinches) result.notes += fmt::format("+{}-pinches-parted", pinches);
  if (result.notes.empty()) return {welded, 0, 0, {}};
  mesh = compacted(mesh);
  return result;
}

}  // namespace liana
