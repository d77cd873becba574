#include "mesher/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesher/geometry/mesh_checks.h"

namespace liana {
namespace {

constexpr uint32_t kLeaf = 8;  // triangles
constexpr double kFar = 2.5;   // radii: beyond that a box counts as one dipole

/// Ericson 2005, §5.1.5.
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? Vec3(a + vb / sum * ab + vc / sum * ac) : a;
}

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(&mesh), items_(mesh.triangles.size()) {
  if (items_.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  for (const Triangle& t : mesh.triangles)
    centres_.push_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3);
  nodes_.push_back({.box = {}, .begin = 0, .end = static_cast<uint32_t>(items_.size())});
  for (uint32_t n = 0; n < nodes_.size(); ++n) build(n);
}

void TriangleTree::build(uint32_t n) {
  Node node = nodes_[n];
  Eigen::AlignedBox3d middles;
  double weight = 0;
  node.centre = node.area_vector = Vec3::Zero();
  for (uint32_t i = node.begin; i < node.end; ++i) {
    const Triangle& t = mesh_->triangles[items_[i]];
    for (const uint32_t v : t) node.box.extend(mesh_->positions[v]);
    middles.extend(centres_[items_[i]]);
    const Vec3 vector = liana::area_vector(*mesh_, t);
    node.area_vector += vector;
    node.centre += vector.norm() * centres_[items_[i]];
    weight += vector.norm();
  }
  node.centre = weight > 0 ? Vec3(node.centre / weight) : node.box.center();
  node.radius = 0;
  for (int corner = 0; corner < 8; ++corner)
    node.radius = std::max(
        node.radius,
        (node.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - node.centre).norm());
  if (node.end - node.begin > kLeaf) {
    int axis;
    middles.sizes().maxCoeff(&axis);
    const uint32_t middle = (node.begin + node.end) / 2;
    std::nth_element(items_.begin() + node.begin, items_.begin() + middle, items_.begin() + node.end,
                     [&](uint32_t a, uint32_t b) { return centres_[a][axis] < centres_[b][axis]; });
    node.children = static_cast<uint32_t>(nodes_.size());
    nodes_[n] = node;
    nodes_.push_back({.box = {}, .begin = node.begin, .end = middle});
    nodes_.push_back({.box = {}, .begin = middle, .end = node.end});
    return;
  }
  nodes_[n] = node;
}

TriangleTree::Hit TriangleTree::nearest(const Vec3& point, double within) const {
  Hit hit{.distance = within};
  if (nodes_.empty()) return hit;
  const auto visit = [&](const auto& self, uint32_t n) -> void {
    const Node& node = nodes_[n];
    if (node.box.squaredExteriorDistance(point) >= hit.distance * hit.distance) return;
    if (node.children) {
      const uint32_t a = node.children, b = a + 1;
      const bool a_first =
          nodes_[a].box.squaredExteriorDistance(point) <= nodes_[b].box.squaredExteriorDistance(point);
      self(self, a_first ? a : b);
      self(self, a_first ? b : a);
      return;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const Triangle& t = mesh_->triangles[items_[i]];
      const Vec3 on =
          nearest_on_triangle(point, mesh_->positions[t[0]], mesh_->positions[t[1]], mesh_->positions[t[2]]);
      const double distance = (on - point).norm();
      if (distance < hit.distance) hit = {on, distance, items_[i]};
    }
  };
  visit(visit, 0);
  return hit;
}

double TriangleTree::winding_number(const Vec3& point) const {
  if (nodes_.empty()) return 0;
  double angle = 0;
  const auto visit = [&](const auto& self, uint32_t n) -> void {
    const Node& node = nodes_[n];
    const Vec3 away = node.centre - point;
    const double distance = away.norm();
    if (node.children && distance <= kFar * node.radius) {
      self(self, node.children);
      self(self, node.children + 1);
      return;
    }
    if (distance > kFar * node.radius) {
      angle += away.dot(node.area_vector) / (distance * distance * distance);
      return;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const Triangle& t = mesh_->triangles[items_[i]];
      const Vec3 a = mesh_->positions[t[0]] - point, b = mesh_->positions[t[1]] - point,
                 c = mesh_->positions[t[2]] - point;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      angle +=
          2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
  };
  visit(visit, 0);
  return angle / (4 * kPi);
}

}  // namespace liana
