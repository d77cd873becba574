#include "mesher/exact/alpha_wrap.h"

#define CGAL_NO_WARNINGS
#define CGAL_DEBUG  // failed checks throw, in release builds too: the caller has other ways
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <functional>

namespace liana {
namespace {

struct TooManyPoints : std::exception {};

/// Ends a wrap that has become too large to be worth it.
struct Guard : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
  size_t points = 0;
  template <typename Wrapper, typename Point>
  void before_Steiner_point_insertion(const Wrapper&, const Point&) {
    if (++points > kMostWrapPoints) throw TooManyPoints{};
  }
};

}  // namespace

std::optional<Mesh> alpha_wrap(const Mesh& triangles, double alpha, double offset) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Vec3& p : triangles.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& t : triangles.triangles) faces.push_back({t[0], t[1], t[2]});
  CGAL::Surface_mesh<Point> wrap;
  Guard guard;
  try {
    CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap, CGAL::parameters::default_values(),
                       CGAL::parameters::visitor(std::ref(guard)));
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
