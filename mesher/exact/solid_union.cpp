#include "mesher/exact/solid_union.h"

#define CGAL_NO_WARNINGS
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>

#include "mesher/geometry/thin_triangles.h"

namespace liana {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Between boxes that begin at the same coordinate, and between the diagonals of a rectangle, CGAL chooses by
// the addresses that they happen to have. Sheared, exactly, neither is left; what is in a plane stays in it.
constexpr double kShear[6] = {0.1837, -0.1291, 0.2173, 0.1549, -0.1103, 0.1961};

Kernel::Point_3 sheared(const Vec3& p) {
  const Kernel::FT x0(p.x()), y0(p.y()), z0(p.z());
  const Kernel::FT x = x0 + kShear[0] * y0 + kShear[1] * z0;
  const Kernel::FT y = y0 + kShear[2] * z0 + kShear[3] * x;
  return {x, y, z0 + kShear[4] * x + kShear[5] * y};
}

/// Where it was before, rounded.
Vec3 restored(const Kernel::Point_3& p) {
  const Kernel::FT z = p.z() - kShear[4] * p.x() - kShear[5] * p.y();
  const Kernel::FT y = p.y() - kShear[2] * z - kShear[3] * p.x();
  const Kernel::FT x = p.x() - kShear[0] * y - kShear[1] * z;
  // Exact: an interval's middle would depend on how it was computed.
  return {CGAL::to_double(x.exact()), CGAL::to_double(y.exact()), CGAL::to_double(z.exact())};
}

ExactMesh exact(const Mesh& mesh) {
  ExactMesh result;
  for (const Vec3& p : mesh.positions) result.add_vertex(sheared(p));
  using Vertex = ExactMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) result.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  return result;
}

size_t shells(const ExactMesh& mesh) {
  std::map<ExactMesh::Face_index, size_t> shell_of;
  return pmp::connected_components(mesh, boost::make_assoc_property_map(shell_of));
}

}  // namespace

struct SolidUnion::Surface {
  ExactMesh mesh;
};

SolidUnion::SolidUnion(const Mesh& solid) : surface_(std::make_unique<Surface>(Surface{exact(solid)})) {}
SolidUnion::~SolidUnion() = default;
SolidUnion::SolidUnion(SolidUnion&&) noexcept = default;

bool SolidUnion::add(const Mesh& solid) {
  ExactMesh before = surface_->mesh, other = exact(solid), both;
  if (!pmp::corefine_and_compute_union(before, other, both)) return false;
  if (shells(both) != 1) return false;
  both.collect_garbage();
  surface_->mesh = std::move(both);
  return true;
}

// CGAL's order of vertices and faces depends on addresses, too: here it is that of their coordinates.
Mesh SolidUnion::mesh(double least) const {
  const ExactMesh& joined = surface_->mesh;
  std::vector<ExactMesh::Vertex_index> order(joined.vertices().begin(), joined.vertices().end());
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return CGAL::compare_xyz(joined.point(a), joined.point(b)) < 0; });
  Mesh result;
  std::vector<uint32_t> place(joined.number_of_vertices());
  for (const auto vertex : order) {
    place[vertex.idx()] = static_cast<uint32_t>(result.positions.size());
    result.positions.push_back(restored(joined.point(vertex)));
  }
  for (const auto face : joined.faces()) {
    Triangle triangle;
    size_t corner = 0;
    for (const auto vertex : joined.vertices_around_face(joined.halfedge(face)))
      triangle[corner++] = place[vertex.idx()];
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    result.triangles.push_back(triangle);
  }
  std::sort(result.triangles.begin(), result.triangles.end());
  return without_thin_triangles(result, least);
}

}  // namespace liana
