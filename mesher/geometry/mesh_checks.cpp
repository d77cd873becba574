#include "mesher/geometry/mesh_checks.h"

#include <algorithm>

namespace liana {
namespace {

struct Side {
  uint32_t low, high;  // the edge's vertices
  uint32_t triangle, edge;
  bool forward;  // runs from low to high
};

}  // namespace

Adjacency find_adjacency(const Mesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  Adjacency result;
  result.across.assign(mesh.triangles.size(), {Adjacency::kNone, Adjacency::kNone, Adjacency::kNone});
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i == 1) result.closed = false;
    if (end - i > 2) result.manifold = false;
    if (end - i == 2) {
      const Side &a = sides[i], &b = sides[i + 1];
      result.across[a.triangle][a.edge] = b.triangle;
      result.across[b.triangle][b.edge] = a.triangle;
      if (a.forward == b.forward) result.oriented = false;
    }
    i = end;
  }
  return result;
}

std::vector<std::vector<uint32_t>> border_loops(const Mesh& mesh, const Adjacency& adjacency) {
  const auto edge_from = [&](uint32_t triangle, uint32_t vertex) -> uint32_t {
    const Triangle& t = mesh.triangles[triangle];
    return t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
  };
  std::vector<std::array<uint8_t, 3>> visited(mesh.triangles.size(), {0, 0, 0});
  std::vector<std::vector<uint32_t>> loops;
  for (uint32_t start = 0; start < mesh.triangles.size(); ++start)
    for (uint32_t k = 0; k < 3; ++k) {
      if (adjacency.across[start][k] != Adjacency::kNone || visited[start][k]) continue;
      std::vector<uint32_t> loop;
      uint32_t triangle = start, edge = k;
      while (!visited[triangle][edge]) {
        visited[triangle][edge] = 1;
        loop.push_back(mesh.triangles[triangle][edge]);
        // Turn around the edge's end, through the triangles there, to the border edge that leaves it.
        const uint32_t pivot = mesh.triangles[triangle][(edge + 1) % 3];
        edge = (edge + 1) % 3;
        size_t turns = 0;
        while (adjacency.across[triangle][edge] != Adjacency::kNone && turns++ < mesh.triangles.size()) {
          triangle = adjacency.across[triangle][edge];
          edge = edge_from(triangle, pivot);
        }
        if (adjacency.across[triangle][edge] != Adjacency::kNone) break;  // round in circles: wound both ways
      }
      loops.push_back(std::move(loop));
    }
  return loops;
}

std::vector<uint32_t> connected_parts(const Adjacency& adjacency, uint32_t* count) {
  std::vector<uint32_t> part(adjacency.across.size(), Adjacency::kNone), stack;
  *count = 0;
  for (uint32_t start = 0; start < part.size(); ++start) {
    if (part[start] != Adjacency::kNone) continue;
    part[start] = *count;
    stack.push_back(start);
    while (!stack.empty()) {
      const uint32_t triangle = stack.back();
      stack.pop_back();
      for (const uint32_t next : adjacency.across[triangle])
        if (next != Adjacency::kNone && part[next] == Adjacency::kNone) {
          part[next] = *count;
          stack.push_back(next);
        }
    }
    ++*count;
  }
  return part;
}

Vec3 area_vector(const Mesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a) / 2;
}

double surface_area(const Mesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += area_vector(mesh, t).norm();
  return area;
}

double signed_volume(const Mesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Vec3 origin = mesh.positions[mesh.triangles[0][0]];  // near the mesh: less cancellation
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles)
    six_volumes += (mesh.positions[t[0]] - origin)
                       .dot((mesh.positions[t[1]] - origin).cross(mesh.positions[t[2]] - origin));
  return six_volumes / 6;
}

}  // namespace liana
