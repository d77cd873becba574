#include "mesher/solids/solidify/support.h"

#include <algorithm>
#include <cmath>

namespace liana {
Support::Support(const SegmentedPlant& plant, DomainId domain) {
  const DomainId parent = plant.domains[domain.index()].parent;
  if (!parent.valid()) return;
  parent_ = &plant.domains[parent.index()].surface;
  for (const Vec3& p : parent_->positions) box_.extend(p);
  tree_ = TriangleTree(*parent_);
}

double Support::distance(const Vec3& point, double best) const {
  return tree_.nearest(point, best).distance;
}

bool Support::inside(const Vec3& point) const {
  if (!box_.contains(point)) return false;
  return std::abs(tree_.winding_number(point)) > 0.5;  // parents may be open tubes and wound either way
}

double Support::depth(const Vec3& point) const {
  if (!parent_) return point.y();
  const double away = distance(point, std::numeric_limits<double>::infinity());
  return inside(point) ? -away : away;
}

uint32_t Support::nearest(const Mesh& mesh, const std::vector<uint32_t>& candidates) const {
  uint32_t best = candidates.front();
  double least = std::numeric_limits<double>::infinity();
  for (const uint32_t v : candidates) {
    const Vec3& p = mesh.positions[v];
    double depth = p.y();
    if (parent_ && inside(p))
      depth = -distance(p, std::numeric_limits<double>::infinity());
    else if (parent_)
      depth = least < 0 ? least : distance(p, least);
    if (depth < least) {
      least = depth;
      best = v;
    }
  }
  return best;
}

}  // namespace liana
