#include "mesher/solids/repair/clean_shell.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "mesher/base/error.h"
#include "mesher/geometry/half_edge.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/repair/enclosed_volume.h"

namespace liana {
namespace {

/// Keeps the first of triangles with the same three corners. Returns how many went; sets `paired` if every
/// remaining triangle had a partner wound the other way.
size_t drop_duplicates(Mesh& mesh, bool& paired) {
  struct Key {
    Triangle corners;
    bool even;  // winding relative to the sorted corners
    uint32_t index;
  };
  std::vector<Key> keys;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    const size_t first = std::find(t.begin(), t.end(), sorted[0]) - t.begin();
    keys.push_back({sorted, t[(first + 1) % 3] == sorted[1], i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.index) < std::tie(b.corners, b.index);
  });
  std::vector<uint32_t> kept;
  size_t back_to_back = 0;
  for (size_t i = 0; i < keys.size();) {
    size_t end = i + 1;
    bool opposite = false;
    for (; end < keys.size() && keys[end].corners == keys[i].corners; ++end)
      opposite = opposite || keys[end].even != keys[i].even;
    kept.push_back(keys[i].index);
    back_to_back += opposite;
    i = end;
  }
  const size_t dropped = mesh.triangles.size() - kept.size();
  paired = back_to_back == kept.size();
  std::sort(kept.begin(), kept.end());
  std::vector<Triangle> triangles;
  for (const uint32_t i : kept) triangles.push_back(mesh.triangles[i]);
  mesh.triangles = std::move(triangles);
  return dropped;
}

/// Longest edge of a triangle without area (corners in one line), or -1 if it has area.
int flat_edge(const Mesh& mesh, const Triangle& t) {
  double edge[3];
  for (int k = 0; k < 3; ++k) edge[k] = (mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]]).norm();
  const auto longest = static_cast<int>(std::max_element(edge, edge + 3) - edge);
  return 2 * area_vector(mesh, t).norm() <= 1e-9 * edge[longest] * edge[longest] ? longest : -1;
}

/// A triangle whose corner c lies on its edge ab is turned: c goes to the neighbour across ab, (b, a, d),
/// which becomes (d, b, c), and the flat one (a, d, c). On a border it is dropped. Returns how many went.
size_t remove_flat_triangles(Mesh& mesh) {
  std::vector<uint32_t> flat;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (flat_edge(mesh, mesh.triangles[i]) >= 0) flat.push_back(i);
  if (flat.empty()) return 0;

  HalfEdgeMesh edges(mesh);
  std::vector<uint8_t> dropped(mesh.triangles.size(), 0);
  size_t removed = 0;
  // A flip can leave another flat one (d on the line too); the bound ends what would go in circles.
  for (size_t steps = 0; !flat.empty() && steps < 4 * mesh.triangles.size(); ++steps) {
    const uint32_t i = flat.back();
    flat.pop_back();
    const int longest = dropped[i] ? -1 : flat_edge(mesh, edges.corners(i));
    if (longest < 0) continue;
    const HalfEdge edge = edges.half_edge(i, longest);
    const uint32_t j = edges.triangle(edges.opposite(edge));
    if (j == HalfEdgeMesh::kNone || dropped[j]) {
      dropped[i] = 1, ++removed;
    } else if (edges.flip(edge)) {
      ++removed;
      for (const uint32_t k : {i, j})
        if (flat_edge(mesh, edges.corners(k)) >= 0) flat.push_back(k);
    }
  }
  mesh.triangles.clear();
  for (uint32_t i = 0; i < dropped.size(); ++i)
    if (!dropped[i]) mesh.triangles.push_back(edges.corners(i));
  return removed;
}

/// Winds every triangle like its neighbours, keeping the first of each part. False if that is impossible.
bool wind_alike(Mesh& mesh, const Adjacency& adjacency, size_t& flipped) {
  const auto runs = [&](uint32_t triangle, uint32_t from, uint32_t to) {
    const Triangle& t = mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k)
      if (t[k] == from && t[(k + 1) % 3] == to) return true;
    return false;
  };
  // Flips are noted and done at the end: adjacency speaks of the edges as they are.
  std::vector<int8_t> flip(mesh.triangles.size(), -1);
  std::vector<uint32_t> stack;
  for (uint32_t start = 0; start < mesh.triangles.size(); ++start) {
    if (flip[start] >= 0) continue;
    flip[start] = 0;
    stack.push_back(start);
    while (!stack.empty()) {
      const uint32_t triangle = stack.back();
      stack.pop_back();
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t next = adjacency.across[triangle][k];
        if (next == Adjacency::kNone) continue;
        const Triangle& t = mesh.triangles[triangle];
        const bool same_direction = runs(next, t[k], t[(k + 1) % 3]);
        const auto wanted = static_cast<int8_t>(flip[triangle] ^ static_cast<int8_t>(same_direction));
        if (flip[next] < 0) {
          flip[next] = wanted;
          stack.push_back(next);
        } else if (flip[next] != wanted) {
          return false;
        }
      }
    }
  }
  flipped = 0;
  for (size_t i = 0; i < flip.size(); ++i)
    if (flip[i]) {
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
      ++flipped;
    }
  return true;
}

/// The edge-connected part with the largest area. Returns the number of parts there were.
uint32_t keep_largest_part(Mesh& mesh, const Adjacency& adjacency, CleanShell& shell) {
  uint32_t count = 0;
  const std::vector<uint32_t> part = connected_parts(adjacency, &count);
  if (count == 1) return 1;
  std::vector<double> area(count, 0);
  for (size_t i = 0; i < part.size(); ++i) area[part[i]] += area_vector(mesh, mesh.triangles[i]).norm();
  const auto largest = static_cast<uint32_t>(std::max_element(area.begin(), area.end()) - area.begin());
  shell.kept = area[largest] / std::accumulate(area.begin(), area.end(), 0.0);
  Mesh kept{mesh.positions, {}}, others{mesh.positions, {}};
  for (size_t i = 0; i < part.size(); ++i)
    (part[i] == largest ? kept : others).triangles.push_back(mesh.triangles[i]);
  shell.lost_volume = enclosed_volume(others);
  mesh = compacted(kept);
  return count;
}

}  // namespace

CleanShell clean_shell(const Mesh& welded, const std::string& where) {
  CleanShell shell;
  shell.mesh = welded;
  Mesh& mesh = shell.mesh;
  bool paired = false;
  const size_t duplicates = drop_duplicates(mesh, paired);
  shell.double_sided = duplicates > 0 && paired;
  if (shell.double_sided)
    shell.notes += "+one-of-two-sides";
  else if (duplicates)
    shell.notes += fmt::format("+{}-duplicates-dropped", duplicates);
  if (const size_t flat = remove_flat_triangles(mesh)) shell.notes += fmt::format("+{}-flat-removed", flat);
  if (mesh.triangles.empty())
    throw Error(Error::Kind::Input, where + ": its surface has no area", "remove it or give it a surface");

  Adjacency adjacency = find_adjacency(mesh);
  if (!adjacency.manifold)
    throw Error(Error::Kind::Input, where + ": three or more of its triangles share an edge",
                "separate the pieces that touch there into nodes of their own, or remove inner faces");
  if (!adjacency.oriented) {
    size_t flipped = 0;
    if (!wind_alike(mesh, adjacency, flipped))
      throw Error(Error::Kind::Input, where + ": its surface has no inside and outside (a Möbius strip)",
                  "cut the surface open where it twists");
    shell.notes += fmt::format("+{}-flipped", flipped);
    adjacency = find_adjacency(mesh);
  }
  const uint32_t parts = keep_largest_part(mesh, adjacency, shell);
  if (parts > 1) shell.notes += fmt::format("+largest-of-{}-shells", parts);
  return shell;
}

}  // namespace liana
