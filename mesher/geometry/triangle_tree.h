// Nearest points on many triangles.
#pragma once

#include <vector>

#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/mesh.h"

namespace liana {

/// A box tree over the triangles of a mesh, which must outlive it.
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
  /// A node's triangles from far away.
  struct Dipole {
    Vec3 centre = Vec3::Zero(), area_vector = Vec3::Zero();
    double radius = 0;  // of the node's box around the centre
  };
  Dipole dipole(const BoxTree::Node& node) const;

  const Mesh* mesh_ = nullptr;
  BoxTree tree_;
  std::vector<Dipole> dipoles_;  // per node
};

}  // namespace liana
