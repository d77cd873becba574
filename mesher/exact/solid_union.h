// Closed surfaces united into one, exactly.
#pragma once

#include <memory>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Intersections are kept as exact numbers until mesh(), so that one union after another stays valid.
class SolidUnion {
 public:
  explicit SolidUnion(const Mesh& solid);  ///< closed, outward, free of self-intersection
  ~SolidUnion();
  SolidUnion(SolidUnion&&) noexcept;

  /// False, and nothing is changed, when the two do not share a volume or their union is no manifold.
  bool add(const Mesh& solid);
  /// Rounded to doubles, without edges and triangles thinner than `least` (m) where that leaves a valid
  /// surface: see thin_triangles.h.
  Mesh mesh(double least) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace liana
