// Nearest points on many triangles.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// A tree of boxes over the triangles of a mesh, which must outlive it. Built in n log n.
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(const Mesh& mesh);

  struct Hit {
    Vec3 point = Vec3::Zero();
    double distance;  ///< m; `within` if nothing is nearer
    uint32_t triangle = Id<Mesh>::kNone;
  };
  Hit nearest(const Vec3& point, double within) const;

  /// Solid angle of all triangles seen from a point, over 4π: 1 inside a closed outward surface, 0 outside
  /// (Van Oosterom and Strackee 1983). Far boxes count as one dipole (Barill et al. 2018): within about 0.01.
  double winding_number(const Vec3& point) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    uint32_t begin = 0, end = 0;  // of items_
    uint32_t children = 0;        // index of the first, the second follows; 0 for a leaf
    Vec3 centre = Vec3::Zero(), area_vector = Vec3::Zero();  // the dipole
    double radius = 0;
  };
  void build(uint32_t node);

  const Mesh* mesh_ = nullptr;
  std::vector<uint32_t> items_;
  std::vector<Vec3> centres_;
  std::vector<Node> nodes_;
};

}  // namespace liana
