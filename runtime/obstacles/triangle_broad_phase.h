// Which triangles may be near a point or along a half line: Embree as a tree of boxes, and no more.
#pragma once

#include <memory>

#include "mesher/base/function_ref.h"
#include "mesher/geometry/mesh.h"

namespace liana {

/// What is nearest or met, the caller finds in double precision: Embree's arithmetic differs between
/// processors, so it only leaves out triangles that are surely not wanted. Safe to ask from several threads.
class TriangleBroadPhase {
 public:
  /// device: Embree's own configuration, such as "isa=sse2". No answer depends on it.
  TriangleBroadPhase(const Mesh& mesh, const char* device);
  ~TriangleBroadPhase();
  TriangleBroadPhase(TriangleBroadPhase&&) noexcept;
  TriangleBroadPhase& operator=(TriangleBroadPhase&&) noexcept;

  /// Calls visit(triangle) for all that may be no further than `radius` (m) from x; what it returns is the
  /// radius from then on, never a larger one.
  void near(const Vec3& x, double radius, FunctionRef<double(uint32_t)> visit) const;

  /// Calls visit(triangle) for all that the half line from x along the unit direction may meet, until it
  /// returns true. Whether it did.
  bool along(const Vec3& x, const Vec3& direction, FunctionRef<bool(uint32_t)> visit) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace liana
