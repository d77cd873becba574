#include "mesher/surface/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "mesher/surface/clearance.h"

namespace liana {

bool self_intersects(const Mesh& mesh) {
  constexpr size_t kQuickProof = 20'000;  // triangles; its sweep grows faster than linearly
  if (mesh.triangles.size() <= kQuickProof && surely_clear(mesh)) return false;
  return self_intersects_exactly(mesh);
}

bool self_intersects_exactly(const Mesh& mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    if (CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) return true;
    triangles.push_back({t[0], t[1], t[2]});
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) return true;
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return pmp::does_self_intersect(surface);
}

}  // namespace liana
