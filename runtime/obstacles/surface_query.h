// Exact questions to a surface: the closest point, and whether a ray meets it.
#pragma once

#include <limits>

#include "runtime/obstacles/closed_mesh.h"
#include "runtime/obstacles/triangle_broad_phase.h"

namespace liana {

/// The closest point of a surface.
struct SurfacePoint {
  Vec3 point;       ///< m
  Vec3 normal;      ///< unit, outwards: the pseudonormal there
  double distance;  ///< m, signed: negative inside
  uint32_t triangle = 0;
};

/// Safe to ask from several threads. Every answer is a pure function of mesh and question, with the same bits
/// on every processor: it is computed in double, ties go to the lowest triangle, Embree only prunes.
class SurfaceQuery {
 public:
  /// sheet = 0: the mesh is closed and solid. Above: it is a sheet, open or not, of that thickness (m), of
  /// which the mesh is the middle; rays meet the middle. Throws Error{Input} as ClosedMesh does.
  /// device: Embree's own configuration, on which no answer depends.
  explicit SurfaceQuery(const Mesh& mesh, double sheet = 0, const char* device = "threads=1");

  /// `within` (m) speeds the search up: a distance the answer is known not to exceed.
  SurfacePoint closest(const Vec3& x, double within = std::numeric_limits<double>::infinity()) const;

  /// Whether the half line from x along the unit direction, leaving out its first `skip` metres, meets the
  /// surface.
  bool ray_meets(const Vec3& x, const Vec3& direction, double skip = 1e-4) const;

  const Mesh& mesh() const { return surface_.mesh(); }  ///< welded
  bool convex() const { return convex_; }  ///< a solid of few triangles that all other vertices lie behind

 private:
  bool is_convex(double size) const;

  ClosedMesh surface_;
  TriangleBroadPhase tree_;
  double half_sheet_;  // m
  bool convex_ = false;
};

}  // namespace liana
