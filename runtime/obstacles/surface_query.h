// Exact questions to a surface, answered by Embree: the closest point, and whether a ray meets it.
#pragma once

#include <limits>
#include <memory>

#include "runtime/obstacles/closed_mesh.h"

namespace liana {

/// The closest point of a surface.
struct SurfacePoint {
  Vec3 point;       ///< m
  Vec3 normal;      ///< unit, outwards: the pseudonormal there
  double distance;  ///< m, signed: negative inside
  uint32_t triangle = 0;
};

/// Safe to ask from several threads. Distances are computed in double; Embree's single precision only prunes.
class SurfaceQuery {
 public:
  /// sheet = 0: the mesh is closed and solid. Above: it is a sheet, open or not, of that thickness (m), of
  /// which the mesh is the middle; rays meet the middle. Throws Error{Input} as ClosedMesh does.
  explicit SurfaceQuery(const Mesh& mesh, double sheet = 0);
  ~SurfaceQuery();
  SurfaceQuery(SurfaceQuery&&) noexcept;
  SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

  /// `within` (m) speeds the search up: a distance the answer is known not to exceed.
  SurfacePoint closest(const Vec3& x, double within = std::numeric_limits<double>::infinity()) const;

  /// Whether the half line from x along the unit direction, leaving out its first `skip` metres, meets the
  /// surface.
  bool ray_meets(const Vec3& x, const Vec3& direction, double skip = 1e-4) const;

  const Mesh& mesh() const;  ///< welded
  bool convex() const;       ///< a solid of few triangles that all other vertices lie behind

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace liana
