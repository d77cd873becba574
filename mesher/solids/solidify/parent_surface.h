// What a domain stands on, and how near a point is to it.
#pragma once

#include <algorithm>
#include <vector>

#include "mesher/geometry/triangle_tree.h"
#include "mesher/plant/segmented_plant.h"

namespace liana {

/// What a domain stands on: its parent's surface, or the ground for a trunk.
class ParentSurface {
 public:
  ParentSurface(const SegmentedPlant& plant, DomainId domain);

  /// m: distance to the parent's surface, negative inside the parent; the height for a trunk.
  double depth(const Vec3& point) const;

  /// m: how far out a point stands: the depth, but 0 anywhere inside the parent.
  double height(const Vec3& point) const { return parent_ ? std::max(depth(point), 0.0) : depth(point); }

  /// The vertex of least depth among the candidates.
  uint32_t nearest(const Mesh& mesh, const std::vector<uint32_t>& candidates) const;

 private:
  double distance(const Vec3& point, double best) const;  ///< m; at most `best`
  bool inside(const Vec3& point) const;

  const Mesh* parent_ = nullptr;
  Eigen::AlignedBox3d box_;
  TriangleTree tree_;  // over the parent's triangles
};

}  // namespace liana
