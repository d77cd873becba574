#include "modal/elements/interpolation.h"

#include <algorithm>
#include <limits>

#include "mesher/base/error.h"
#include "modal/elements/element_matrices.h"

namespace liana {
namespace {

using Barycentric = std::array<double, 4>;

Barycentric barycentric(const NodeMesh& mesh, size_t e, const TetGeometry& tet, const Vec3& point) {
  const Vec3 from_first = point - mesh.positions[mesh.element(e)[0]];
  Barycentric L{1, 0, 0, 0};
  for (int k = 1; k < 4; ++k) L[k] = tet.gradients[k].dot(from_first), L[0] -= L[k];
  return L;
}

/// How far the point lies beyond the planes of the tet's faces, m; 0 inside.
double distance_outside(const Barycentric& L, const TetGeometry& tet) {
  double distance = 0;
  for (int k = 0; k < 4; ++k) distance = std::max(distance, -L[k] / tet.gradients[k].norm());
  return distance;
}

}  // namespace

std::vector<NodeWeight> interpolate_at(const NodeMesh& mesh, const Vec3& point) {
  require(mesh.element_count() > 0, "a mesh without elements moves nothing");
  size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t e = 0; e < mesh.element_count() && least > 0; ++e) {
    const TetGeometry tet = element_geometry(mesh, e, 1);
    const double distance = distance_outside(barycentric(mesh, e, tet, point), tet);
    if (distance < least) least = distance, nearest = e;
  }

  const TetGeometry tet = element_geometry(mesh, nearest, 1);
  const auto nodes = mesh.element(nearest);
  const Barycentric at = barycentric(mesh, nearest, tet, point);
  Barycentric L;  // the place in the element
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += L[k] = std::max(0.0, at[k]);
  for (double& l : L) l /= sum;
  const auto beyond = [&](int k) { return at[k] - L[k]; };  // ∇L_k · (point − place)

  std::vector<NodeWeight> weights;
  for (size_t a = 0; a < nodes.size(); ++a) {
    double weight;
    if (nodes.size() == 4) {
      weight = at[a];
    } else if (a < 4) {
      const int k = static_cast<int>(a);
      weight = L[k] * (2 * L[k] - 1) + (4 * L[k] - 1) * beyond(k);
    } else {
      const auto [c, d] = kTetEdges[a - 4];
      weight = 4 * (L[c] * L[d] + L[d] * beyond(c) + L[c] * beyond(d));
    }
    if (weight != 0) weights.push_back({nodes[a], weight});
  }
  return weights;
}

}  // namespace liana
