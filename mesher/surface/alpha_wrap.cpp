#include "mesher/surface/alpha_wrap.h"

#define CGAL_DEBUG  // failed checks throw, in release builds too: the caller has other ways
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

namespace liana {

std::optional<Mesh> alpha_wrap(const Mesh& triangles, double alpha, double offset) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Vec3& p : triangles.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& t : triangles.triangles) faces.push_back({t[0], t[1], t[2]});
  CGAL::Surface_mesh<Point> wrap;
  try {
    CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap);
  } catch (const std::exception&) {
    return {};
  }
  Mesh mesh;
  for (const auto v : wrap.vertices()) {
    const Point& p = wrap.point(v);
    mesh.positions.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : wrap.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    int k = 0;
    for (const auto v : wrap.vertices_around_face(wrap.halfedge(f))) t[k++] = static_cast<uint32_t>(v);
  }
  if (mesh.triangles.empty()) return {};
  return mesh;
}

}  // namespace liana
