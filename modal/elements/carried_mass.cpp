#include "modal/elements/carried_mass.h"

#include <algorithm>
#include <limits>

#include "mesher/base/error.h"
#include "modal/elements/boundary_faces.h"

namespace liana {
namespace {

using Face = std::array<uint32_t, 3>;

/// Barycentric coordinates of the point of segment ab nearest to p.
std::pair<double, double> nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length2 = (b - a).squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
  return {1 - t, t};
}

/// Barycentric coordinates of the point of triangle abc nearest to p.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const Vec3 inside((c - b).cross(p - b).dot(normal) / area2, (a - c).cross(p - c).dot(normal) / area2,
                      (b - a).cross(p - a).dot(normal) / area2);
    if (inside.minCoeff() >= 0) return inside;
  }
  const auto [ab0, ab1] = nearest_on_segment(p, a, b);
  const auto [bc0, bc1] = nearest_on_segment(p, b, c);
  const auto [ca0, ca1] = nearest_on_segment(p, c, a);
  const Vec3 candidates[3] = {{ab0, ab1, 0}, {0, bc0, bc1}, {ca1, 0, ca0}};
  return *std::min_element(candidates, candidates + 3, [&](const Vec3& u, const Vec3& v) {
    return (u[0] * a + u[1] * b + u[2] * c - p).squaredNorm() <
           (v[0] * a + v[1] * b + v[2] * c - p).squaredNorm();
  });
}

}  // namespace

std::vector<NodeMass> lump(const TetMesh& mesh, std::span<const CarriedMass> carried) {
  std::vector<NodeMass> lumped;
  if (carried.empty()) return lumped;
  const std::vector<Face> faces = boundary_faces(mesh);
  for (const CarriedMass& item : carried) {
    require(item.mass >= 0 && item.position.allFinite(), "a carried mass must be finite and not negative");
    double nearest = std::numeric_limits<double>::infinity();
    Face face{};
    Vec3 weights = Vec3::Zero();
    for (const Face& f : faces) {
      const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
      // The face is within its longest edges of its first corner: most are ruled out by that alone.
      const double reach = std::sqrt(std::max((b - a).squaredNorm(), (c - a).squaredNorm()));
      if ((item.position - a).norm() - reach > nearest) continue;
      const Vec3 w = nearest_on_triangle(item.position, a, b, c);
      const double distance = (w[0] * a + w[1] * b + w[2] * c - item.position).norm();
      if (distance < nearest) nearest = distance, face = f, weights = w;
    }
    for (int k = 0; k < 3; ++k)
      if (weights[k] > 0) lumped.push_back({face[k], weights[k] * item.mass});
  }
  return lumped;
}

}  // namespace liana
