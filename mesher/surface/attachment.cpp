#include "mesher/surface/attachment.h"

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

/// Distance from a point to a triangle: to its plane if the foot lies inside, else to the nearest edge.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const auto left_of = [&](const Vec3& from, const Vec3& to) {
    return normal.cross(to - from).dot(p - from) >= 0;
  };
  if (normal.squaredNorm() > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a))
    return std::abs(normal.dot(p - a)) / normal.norm();
  const auto to_edge = [&](const Vec3& from, const Vec3& to) {
    const double along = (p - from).dot(to - from) / std::max((to - from).squaredNorm(), 1e-300);
    return (from + std::clamp(along, 0.0, 1.0) * (to - from) - p).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

}  // namespace

Attachment::Attachment(const SegmentedPlant& plant, DomainId domain) {
  const DomainId parent = plant.domains[domain.index()].parent;
  if (!parent.valid()) return;
  parent_ = &plant.domains[parent.index()].surface;
  for (const Vec3& p : parent_->positions) box_.extend(p);
  for (const Triangle& t : parent_->triangles) {
    const Vec3 centre = (parent_->positions[t[0]] + parent_->positions[t[1]] + parent_->positions[t[2]]) / 3;
    double radius = 0;
    for (const uint32_t v : t) radius = std::max(radius, (parent_->positions[v] - centre).norm());
    centres_.push_back(centre);
    radii_.push_back(radius);
  }
}

double Attachment::distance(const Vec3& point, double best) const {
  for (size_t i = 0; i < centres_.size(); ++i) {
    if ((point - centres_[i]).squaredNorm() > std::pow(best + radii_[i], 2)) continue;
    const Triangle& t = parent_->triangles[i];
    best = std::min(best, distance_to_triangle(point, parent_->positions[t[0]], parent_->positions[t[1]],
                                               parent_->positions[t[2]]));
  }
  return best;
}

bool Attachment::inside(const Vec3& point) const {
  if (!box_.contains(point)) return false;
  // Winding number by solid angles (Van Oosterom and Strackee 1983); parents may be open tubes and wound
  // either way.
  double angle = 0;
  for (const Triangle& t : parent_->triangles) {
    const Vec3 a = parent_->positions[t[0]] - point, b = parent_->positions[t[1]] - point,
               c = parent_->positions[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2 * kPi;  // more than half of the full 4π
}

double Attachment::depth(const Vec3& point) const {
  if (!parent_) return point.y();
  const double away = distance(point, std::numeric_limits<double>::infinity());
  return inside(point) ? -away : away;
}

uint32_t Attachment::nearest(const Mesh& mesh, const std::vector<uint32_t>& candidates) const {
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
