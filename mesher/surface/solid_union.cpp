#include "mesher/surface/solid_union.h"

#define CGAL_NO_WARNINGS
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include "mesher/surface/thin_triangles.h"

namespace liana {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Kernel::Point_3>;

ExactMesh exact(const Mesh& mesh) {
  ExactMesh result;
  for (const Vec3& p : mesh.positions) result.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
  using Vertex = ExactMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) result.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  return result;
}

size_t shells(const ExactMesh& mesh) {
  std::map<ExactMesh::Face_index, size_t> shell_of;
  return pmp::connected_components(mesh, boost::make_assoc_property_map(shell_of));
}

Vec3 rounded(const Kernel::Point_3& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
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

Mesh SolidUnion::mesh(double least) const {
  const ExactMesh& joined = surface_->mesh;
  Mesh result;
  for (const auto vertex : joined.vertices()) result.positions.push_back(rounded(joined.point(vertex)));
  for (const auto face : joined.faces()) {
    Triangle triangle;
    size_t corner = 0;
    for (const auto vertex : joined.vertices_around_face(joined.halfedge(face)))
      triangle[corner++] = static_cast<uint32_t>(vertex.idx());
    result.triangles.push_back(triangle);
  }
  return without_thin_triangles(result, least);
}

}  // namespace liana
