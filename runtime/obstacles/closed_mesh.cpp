#include "runtime/obstacles/closed_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"

namespace liana {
namespace {

Mesh welded(const Mesh& mesh) {
  Mesh result;
  std::map<std::tuple<double, double, double>, uint32_t> seen;
  std::vector<uint32_t> renamed;
  for (const Vec3& p : mesh.positions) {
    if (!p.allFinite())
      throw Error(Error::Kind::Input, fmt::format("obstacle vertex {} is not a finite point", renamed.size()),
                  "export the mesh again");
    const auto [found, is_new] = seen.try_emplace({p.x(), p.y(), p.z()}, result.positions.size());
    if (is_new) result.positions.push_back(p);
    renamed.push_back(found->second);
  }
  for (const Triangle& t : mesh.triangles) {
    for (uint32_t corner : t)
      if (corner >= renamed.size())
        throw Error(Error::Kind::Input,
                    fmt::format("an obstacle triangle names vertex {} of {}", corner, renamed.size()),
                    "export the mesh again");
    const Triangle r{renamed[t[0]], renamed[t[1]], renamed[t[2]]};
    if (r[0] != r[1] && r[1] != r[2] && r[2] != r[0]) result.triangles.push_back(r);
  }
  if (result.triangles.empty())
    throw Error(Error::Kind::Input, "an obstacle mesh has no triangles", "give it a closed surface");
  return result;
}

using Edge = std::pair<uint32_t, uint32_t>;

/// Every edge must be walked as often one way as the other.
void require_closed(const Mesh& mesh) {
  std::map<Edge, int> balance;
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = t[i], b = t[(i + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  size_t open = 0;
  Vec3 place = Vec3::Zero();
  for (const auto& [edge, count] : balance)
    if (count != 0 && open++ == 0) place = (mesh.positions[edge.first] + mesh.positions[edge.second]) / 2;
  if (open > 0)
    throw Error(Error::Kind::Input,
                fmt::format("an obstacle surface is not closed: {} of {} edges lack a neighbour, one at "
                            "({:.3f}, {:.3f}, {:.3f}) m",
                            open, balance.size(), place.x(), place.y(), place.z()),
                "close its holes, give a sheet a thickness, and let all triangles look outwards");
}

double six_volumes(const Mesh& mesh) {
  double sum = 0;
  const Vec3 origin = mesh.positions.front();
  for (const Triangle& t : mesh.triangles)
    sum += (mesh.positions[t[0]] - origin)
               .dot((mesh.positions[t[1]] - origin).cross(mesh.positions[t[2]] - origin));
  return sum;
}

TrianglePoint closest_on_edge(const Vec3& x, const Vec3& a, const Vec3& b, int edge) {
  const Vec3 along = b - a;
  const double t = (x - a).dot(along) / along.squaredNorm();
  if (!(t > 0)) return {a, {TriangleFeature::Corner, uint8_t(edge)}, (x - a).squaredNorm()};
  if (t >= 1) return {b, {TriangleFeature::Corner, uint8_t((edge + 1) % 3)}, (x - b).squaredNorm()};
  const Vec3 p = a + t * along;
  return {p, {TriangleFeature::Edge, uint8_t(edge)}, (x - p).squaredNorm()};
}

}  // namespace

TrianglePoint closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<const Vec3*, 3> corners = {&a, &b, &c};
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  bool inside = area > 0;
  for (int i = 0; i < 3 && inside; ++i) {
    const Vec3 &p = *corners[i], &q = *corners[(i + 1) % 3];
    inside = normal.dot((q - p).cross(x - p)) > 0;
  }
  if (inside) {
    const double height = (x - a).dot(normal);
    return {x - normal * (height / area), {TriangleFeature::Face, 0}, height * height / area};
  }
  TrianglePoint best = closest_on_edge(x, a, b, 0);
  for (int i = 1; i < 3; ++i) {
    const TrianglePoint other = closest_on_edge(x, *corners[i], *corners[(i + 1) % 3], i);
    if (other.squared_distance < best.squared_distance) best = other;
  }
  return best;
}

ClosedMesh::ClosedMesh(const Mesh& source, bool may_be_open) : mesh_(welded(source)) {
  if (!may_be_open) require_closed(mesh_);
  if (!may_be_open && !(six_volumes(mesh_) > 0))
    throw Error(Error::Kind::Input, "an obstacle surface is inside out or encloses no volume",
                "let its triangles wind counter-clockwise seen from outside");

  corner_normals_.assign(mesh_.positions.size(), Vec3::Zero());
  std::map<Edge, Vec3> edges;
  for (const Triangle& t : mesh_.triangles) {
    const Vec3 p[3] = {mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]};
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();  // zero for a sliver of no area
    face_normals_.push_back(normal);
    for (int i = 0; i < 3; ++i) {
      const Vec3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      corner_normals_[t[i]] += normal * fixed::atan2(u.cross(v).norm(), u.dot(v));
      edges.try_emplace(std::minmax(t[i], t[(i + 1) % 3]), Vec3::Zero()).first->second += normal;
    }
  }
  for (Vec3& n : corner_normals_) n.stableNormalize();
  for (const Triangle& t : mesh_.triangles) {
    edge_normals_.emplace_back();
    for (int i = 0; i < 3; ++i)
      edge_normals_.back()[i] = edges.at(std::minmax(t[i], t[(i + 1) % 3])).stableNormalized();
  }
}

const Vec3& ClosedMesh::pseudonormal(uint32_t triangle, TriangleFeature feature) const {
  switch (feature.kind) {
    case TriangleFeature::Face:
      return face_normals_[triangle];
    case TriangleFeature::Edge:
      return edge_normals_[triangle][feature.index];
    default:
      return corner_normals_[mesh_.triangles[triangle][feature.index]];
  }
}

}  // namespace liana
