#include "mesher/geometry/mesh_checks.h"

#include <algorithm>
#include <numeric>

#include "mesher/geometry/disjoint_sets.h"
#include "mesher/geometry/edge_key.h"
#include "mesher/geometry/half_edge.h"

namespace liana {
namespace {

struct Side {
  uint64_t key;  // of the edge
  uint32_t triangle, edge;
  bool forward;  // runs from the smaller number to the larger
};

}  // namespace

Adjacency find_adjacency(const Mesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({edge_key(a, b), t, k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.key, a.triangle) < std::tie(b.key, b.triangle);
  });
  Adjacency result;
  result.across.assign(mesh.triangles.size(), {Adjacency::kNone, Adjacency::kNone, Adjacency::kNone});
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].key == sides[i].key) ++end;
    if (end - i == 1) result.closed = false;
    if (end - i > 2) {
      result.manifold = false;
      result.crowded.resize(mesh.triangles.size(), {0, 0, 0});
      for (size_t s = i; s < end; ++s) result.crowded[sides[s].triangle][sides[s].edge] = 1;
    }
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
  if (adjacency.closed && adjacency.manifold && adjacency.oriented) return {};
  return HalfEdgeMesh(mesh, adjacency).border_loops();
}

std::vector<uint32_t> connected_parts(const Adjacency& adjacency, uint32_t* count) {
  DisjointSets parts(adjacency.across.size());
  for (uint32_t triangle = 0; triangle < adjacency.across.size(); ++triangle)
    for (const uint32_t next : adjacency.across[triangle])
      if (next != Adjacency::kNone) parts.unite(triangle, next);
  return parts.numbered(count);
}

std::vector<Eigen::AlignedBox3d> triangle_boxes(const Mesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes(mesh.triangles.size());
  for (size_t i = 0; i < boxes.size(); ++i)
    for (const uint32_t v : mesh.triangles[i]) boxes[i].extend(mesh.positions[v]);
  return boxes;
}

VertexTriangles::VertexTriangles(const Mesh& mesh)
    : first_(mesh.positions.size() + 1, 0), around_(3 * mesh.triangles.size()) {
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (const uint32_t v : mesh.triangles[i]) around_[next[v]++] = i;
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
