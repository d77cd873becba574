// Closed surfaces united into one, exactly.
#pragma once

#include <memory>

#include "mesher/base/mesh.h"

namespace liana {

/// Intersections are kept as exact numbers until mesh(), so that one union after another stays valid.
class SolidUnion {
 public:
  explicit SolidUnion(const Mesh& solid);  ///< closed, outward, free of self-intersection
  ~SolidUnion();
  SolidUnion(SolidUnion&&) noexcept;

  /// False, and nothing is changed, when the two do not share a volume or their union is no manifold.
  bool add(const Mesh& solid);
  /// Rounded to doubles; vertices nearer to each other than `least_edge` (m) are joined where that leaves a
  /// valid surface.
  Mesh mesh(double least_edge) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace liana
