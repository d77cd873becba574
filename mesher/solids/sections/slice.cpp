#include "mesher/solids/sections/slice.h"

#include <unordered_map>

#include "mesher/geometry/edge_key.h"

namespace liana {
namespace {

Vec3 crossing(const Mesh& mesh, const std::vector<double>& value, uint64_t key) {
  const auto [a, b] = edge_ends(key);
  return mesh.positions[a] + value[a] / (value[a] - value[b]) * (mesh.positions[b] - mesh.positions[a]);
}

}  // namespace

std::vector<std::vector<Vec3>> zero_contours(const Mesh& closed, const std::vector<double>& value) {
  // Zero counts as positive: every crossed triangle has one edge entering and one leaving, as the mesh is
  // closed.
  std::unordered_map<uint64_t, uint64_t> next;  // edge entered -> edge left, in each triangle
  std::vector<uint64_t> order;
  for (const Triangle& t : closed.triangles) {
    uint64_t enter = 0, leave = 0;
    int crossings = 0;
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      if ((value[a] < 0) == (value[b] < 0)) continue;
      ++crossings;
      (value[a] < 0 ? leave : enter) = edge_key(a, b);
    }
    if (crossings == 2) {
      next.emplace(enter, leave);
      order.push_back(enter);
    }
  }
  std::vector<std::vector<Vec3>> contours;
  for (const uint64_t start : order) {
    std::vector<Vec3> contour;
    uint64_t edge = start;
    for (auto step = next.find(edge); step != next.end(); step = next.find(edge)) {
      contour.push_back(crossing(closed, value, edge));
      edge = step->second;
      next.erase(step);
    }
    if (contour.size() >= 3) contours.push_back(std::move(contour));
  }
  return contours;
}

PolygonMoments polygon_moments(const std::vector<Vec3>& polygon) {
  PolygonMoments result;
  const Vec3 origin = polygon[0];
  Vec3 normal = Vec3::Zero();
  for (size_t i = 0; i < polygon.size(); ++i)
    normal += (polygon[i] - origin).cross(polygon[(i + 1) % polygon.size()] - origin) / 2;
  result.area = normal.norm();
  if (!(result.area > 0)) return result;
  normal.normalize();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);

  // Green's theorem over the edges (p, q): area ½ c, first moments c (p + q)/6, second c (p² + p q + q²)/12.
  double area = 0, su = 0, sv = 0, uu = 0, uv = 0, vv = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 a = polygon[i] - origin, b = polygon[(i + 1) % polygon.size()] - origin;
    const double pu = a.dot(u), pv = a.dot(v), qu = b.dot(u), qv = b.dot(v), c = pu * qv - qu * pv;
    area += c / 2;
    su += c * (pu + qu) / 6;
    sv += c * (pv + qv) / 6;
    uu += c * (pu * pu + pu * qu + qu * qu) / 12;
    vv += c * (pv * pv + pv * qv + qv * qv) / 12;
    uv += c * (2 * pu * pv + pu * qv + qu * pv + 2 * qu * qv) / 24;
  }
  const double mu = su / area, mv = sv / area;
  double height = 0;  // of the polygon's middle over the origin, along the normal
  for (const Vec3& p : polygon) height += (p - origin).dot(normal) / double(polygon.size());
  result.centroid = origin + mu * u + mv * v + height * normal;
  Eigen::Matrix2d moments;
  moments << uu - area * mu * mu, uv - area * mu * mv, uv - area * mu * mv, vv - area * mv * mv;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(moments);
  result.along_thin = axes.eigenvalues()[0];
  result.along_wide = axes.eigenvalues()[1];
  result.thin = axes.eigenvectors()(0, 0) * u + axes.eigenvectors()(1, 0) * v;
  result.wide = axes.eigenvectors()(0, 1) * u + axes.eigenvectors()(1, 1) * v;
  return result;
}

}  // namespace liana
