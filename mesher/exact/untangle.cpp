#include "mesher/exact/untangle.h"

#define CGAL_NO_WARNINGS
#define CGAL_DEBUG  // failed checks throw, in release builds too: the caller has other ways
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <unordered_map>

namespace liana {

std::optional<Mesh> untangled(const Mesh& closed) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Vec3& p : closed.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangle& t : closed.triangles) triangles.push_back({t[0], t[1], t[2]});
  CGAL::Surface_mesh<Point> surface;
  try {
    if (!pmp::is_polygon_soup_a_polygon_mesh(triangles)) return {};
    pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
    if (!pmp::experimental::remove_self_intersections(surface, CGAL::parameters::preserve_genus(false)))
      return {};
  } catch (const std::exception&) {
    return {};
  }
  Mesh mesh;
  std::unordered_map<std::size_t, uint32_t> place;
  for (const auto f : surface.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) {
      const auto [it, is_new] =
          place.try_emplace(static_cast<std::size_t>(v), static_cast<uint32_t>(mesh.positions.size()));
      if (is_new) {
        const Point& p = surface.point(v);
        mesh.positions.emplace_back(p.x(), p.y(), p.z());
      }
      t[k++] = it->second;
    }
  }
  if (mesh.triangles.empty()) return {};
  return mesh;
}

}  // namespace liana
