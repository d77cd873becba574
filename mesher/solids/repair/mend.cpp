#include "mesher/solids/repair/mend.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "mesher/geometry/mesh_checks.h"
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

  std::map<uint32_t, std::vector<std::pair<double, uint32_t>>> on_edge;  // triangle -> (place, vertex)
  std::map<uint32_t, uint32_t> edge_of;
  for (const BorderEdge& e : border) {
    if (edge_of.count(e.triangle)) continue;  // one edge a triangle and pass
    const Triangle& t = mesh.triangles[e.triangle];
    const uint32_t a = t[e.edge], b = t[(e.edge + 1) % 3];
    const Vec3 along = mesh.positions[b] - mesh.positions[a];
    const double length = along.norm();
    for (const uint32_t v : vertices) {
      if (v == t[0] || v == t[1] || v == t[2]) continue;
      const Vec3 from = mesh.positions[v] - mesh.positions[a];
      const double place = from.dot(along) / (length * length);
      if (place < kSlit || place > 1 - kSlit || (from - place * along).norm() > kSlit * length) continue;
      on_edge[e.triangle].push_back({place, v});
      edge_of[e.triangle] = e.edge;
    }
  }
  size_t split = 0;
  for (auto& [triangle, list] : on_edge) {
    std::sort(list.begin(), list.end());
    const Triangle t = mesh.triangles[triangle];
    const uint32_t k = edge_of[triangle], opposite = t[(k + 2) % 3];
    uint32_t from = t[k];
    for (const auto& [place, v] : list) {
      mesh.triangles.push_back({from, v, opposite});
      from = v;
      ++split;
    }
    mesh.triangles[triangle] = {from, t[(k + 1) % 3], opposite};
  }
  return split;
}

/// Removes the smallest patch (triangles connected over edges of two) at an edge of three or more triangles:
/// a wall across a tube is smaller than what it closes off. False if there is no such edge, or if the patch
/// is no small part of the whole.
bool drop_patch(Mesh& mesh, double& volume) {
  const Adjacency adjacency = find_adjacency(mesh);
  if (adjacency.manifold) return false;
  std::unordered_map<uint64_t, int> uses;
  const auto key = [](uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); };
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++uses[key(t[k], t[(k + 1) % 3])];
  uint32_t count = 0;
  const std::vector<uint32_t> part = connected_parts(adjacency, &count);
  std::vector<double> area(count, 0), rim(count, 0);
  std::vector<uint8_t> at_joint(count, 0), has_border(count, 0);
  for (size_t i = 0; i < part.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    area[part[i]] += area_vector(mesh, t).norm();
    for (int k = 0; k < 3; ++k) {
      const int n = uses[key(t[k], t[(k + 1) % 3])];
      has_border[part[i]] |= n == 1;
      at_joint[part[i]] |= n > 2;
      if (n > 2) rim[part[i]] += (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm();
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
  const Adjacency adjacency = find_adjacency(mesh);
  // Corners that share an edge at the vertex belong to one fan: union-find over 3 t + k.
  std::vector<uint32_t> up(3 * mesh.triangles.size());
  std::iota(up.begin(), up.end(), 0u);
  const auto top = [&](uint32_t c) {
    while (up[c] != c) c = up[c] = up[up[c]];
    return c;
  };
  const auto corner = [&](uint32_t t, uint32_t v) {
    const Triangle& triangle = mesh.triangles[t];
    return 3 * t + (triangle[0] == v ? 0 : triangle[1] == v ? 1 : 2);
  };
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t other = adjacency.across[t][k];
      if (other == Adjacency::kNone) continue;
      for (const uint32_t v : {mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]})
        up[top(corner(other, v))] = top(corner(t, v));
    }
  std::vector<uint32_t> fan_of(mesh.positions.size(), Id<Mesh>::kNone);  // the first fan keeps the vertex
  std::map<uint32_t, uint32_t> copy_of;                                  // fan -> new vertex
  const std::vector<Triangle> before = mesh.triangles;
  std::vector<std::pair<uint32_t, uint32_t>> copies;  // old, new
  for (uint32_t t = 0; t < before.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t v = before[t][k], fan = top(3 * t + k);
      if (fan_of[v] == Id<Mesh>::kNone) fan_of[v] = fan;
      if (fan_of[v] == fan) continue;
      const auto [it, is_new] = copy_of.try_emplace(fan, static_cast<uint32_t>(mesh.positions.size()));
      if (is_new) {
        mesh.positions.push_back(mesh.positions[v]);
        copies.push_back({v, it->second});
      }
      mesh.triangles[t][k] = it->second;
    }
  if (copies.empty()) return 0;
  std::vector<uint8_t> moves(mesh.positions.size(), 0);
  for (const auto& [old, copy] : copies) moves[old] = moves[copy] = 1;
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
  return copies.size();
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
