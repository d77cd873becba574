#include "mesher/solids/repair/pull_back.h"

#include "mesher/geometry/triangle_tree.h"

namespace liana {

Mesh pull_back(const Mesh& wrap, const Mesh& triangles, double reach) {
  const TriangleTree tree(triangles);
  Mesh pulled = wrap;
  for (Vec3& p : pulled.positions) {
    const TriangleTree::Hit hit = tree.nearest(p, reach);
    if (hit.triangle != Id<Mesh>::kNone) p = hit.point;
  }
  return pulled;
}

}  // namespace liana
