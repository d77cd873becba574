#include "runtime/obstacles/surface_query.h"

#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr size_t kFew = 24;         // triangles that are looked at faster than a tree finds out which
constexpr double kRounding = 1e-9;  // m: more than any distance here is off

/// The nearest triangle so far.
struct Search {
  const ClosedMesh& surface;
  Vec3 x;
  double limit;  // m², beyond which a triangle is of no use
  TrianglePoint best = {{}, {}, std::numeric_limits<double>::infinity()};
  uint32_t triangle = Id<void>::kNone;

  // Ties go to the lowest triangle, so that the answer does not depend on the order of the search.
  void consider(uint32_t candidate) {
    const Mesh& mesh = surface.mesh();
    const Triangle& t = mesh.triangles[candidate];
    const double height = (x - mesh.positions[t[0]]).dot(surface.face_normal(candidate));
    if (height * height > limit) return;
    const TrianglePoint found =
        closest_on_triangle(x, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    if (found.squared_distance > best.squared_distance ||
        (found.squared_distance == best.squared_distance && candidate >= triangle))
      return;
    best = found;
    triangle = candidate;
    // Heights and distances round differently: on the surface both are rounding.
    const double rounded = std::sqrt(found.squared_distance) * (1 + 1e-9) + kRounding;
    limit = rounded * rounded;
  }
};

/// Whether the half line from x meets triangle abc beyond its first `skip` metres. Edges belong to both of
/// their triangles: their side is found by the same products, with signs reversed, so no ray slips through
/// between.
bool meets(const Vec3& x, const Vec3& direction, double skip, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 p = a - x, q = b - x, r = c - x;
  const double u = direction.dot(q.cross(r)), v = direction.dot(r.cross(p)), w = direction.dot(p.cross(q));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const Vec3 normal = (b - a).cross(c - a);
  const double steepness = normal.dot(direction);
  return steepness != 0 && normal.dot(p) / steepness > skip;
}

}  // namespace

SurfaceQuery::SurfaceQuery(const Mesh& mesh, double sheet, const char* device)
    : surface_(mesh, sheet > 0), tree_(surface_.mesh(), device), half_sheet_(sheet / 2) {
  const std::vector<Vec3>& positions = surface_.mesh().positions;
  Vec3 low = positions.front(), high = low;
  for (const Vec3& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  convex_ = sheet == 0 && is_convex((high - low).norm());
}

bool SurfaceQuery::is_convex(double size) const {
  constexpr double kMost = 1e6, kRounding = 1e-14;
  const Mesh& m = surface_.mesh();
  if (static_cast<double>(m.triangles.size()) * static_cast<double>(m.positions.size()) > kMost) return false;
  for (uint32_t i = 0; i < m.triangles.size(); ++i)
    for (const Vec3& p : m.positions)
      if ((p - m.positions[m.triangles[i][0]]).dot(surface_.face_normal(i)) > kRounding * size) return false;
  return true;
}

SurfacePoint SurfaceQuery::closest(const Vec3& x, double within) const {
  const double reach = (within + half_sheet_) * (1 + 1e-6) + kRounding;
  Search search{surface_, x, reach * reach};
  if (const size_t count = mesh().triangles.size(); count <= kFew)
    for (uint32_t i = 0; i < count; ++i) search.consider(i);
  else
    tree_.near(x, reach, [&](uint32_t triangle) {
      search.consider(triangle);
      return std::sqrt(search.limit);
    });
  require(search.triangle != Id<void>::kNone, "no closest point within the promised distance");

  const double distance = std::sqrt(search.best.squared_distance);
  const Vec3& normal = surface_.pseudonormal(search.triangle, search.best.feature);
  if (half_sheet_ > 0) {
    const Vec3 away = distance > 1e-9 ? Vec3((x - search.best.point) / distance) : normal;
    return {search.best.point + half_sheet_ * away, away, distance - half_sheet_, search.triangle};
  }
  const bool inside = (x - search.best.point).dot(normal) < 0;
  return {search.best.point, normal, inside ? -distance : distance, search.triangle};
}

bool SurfaceQuery::ray_meets(const Vec3& x, const Vec3& direction, double skip) const {
  const Mesh& m = mesh();
  return tree_.along(x, direction, [&](uint32_t triangle) {
    const Triangle& t = m.triangles[triangle];
    return meets(x, direction, skip, m.positions[t[0]], m.positions[t[1]], m.positions[t[2]]);
  });
}

}  // namespace liana
