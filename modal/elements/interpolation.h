// The displacement of any point that moves with a T10 or T4 mesh, from its nodes.
#pragma once

#include <vector>

#include "modal/elements/node_mesh.h"

namespace liana {

struct NodeWeight {
  uint32_t node;
  double weight;
};

/// u(point) = Σ weight · u(node), from the element that holds the point or the one nearest to it. Outside,
/// the element's displacement is continued linearly from its nearest place: a rigid motion stays exact.
std::vector<NodeWeight> interpolate_at(const NodeMesh& mesh, const Vec3& point);

}  // namespace liana
