#include "mesher/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

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

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(&mesh), tree_(triangle_boxes(mesh), kLeaf) {
  dipoles_.reserve(tree_.nodes().size());
  for (const BoxTree::Node& node : tree_.nodes()) dipoles_.push_back(dipole(node));
}

TriangleTree::Dipole TriangleTree::dipole(const BoxTree::Node& node) const {
  Dipole result;
  double weight = 0;
  for (const uint32_t i : tree_.items(node)) {
    const Triangle& t = mesh_->triangles[i];
    const Vec3 vector = area_vector(*mesh_, t);
    result.area_vector += vector;
    result.centre +=
        vector.norm() / 3 * (mesh_->positions[t[0]] + mesh_->positions[t[1]] + mesh_->positions[t[2]]);
    weight += vector.norm();
  }
  result.centre = weight > 0 ? Vec3(result.centre / weight) : node.box.center();
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    result.radius = std::max(result.radius, (node.box.corner(type) - result.centre).norm());
  }
  return result;
}

TriangleTree::Hit TriangleTree::nearest(const Vec3& point, double within) const {
  Hit hit{.distance = within};
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  if (nodes.empty()) return hit;
  const auto visit = [&](const auto& self, uint32_t n) -> void {
    const BoxTree::Node& node = nodes[n];
    if (node.box.squaredExteriorDistance(point) >= hit.distance * hit.distance) return;
    if (node.children) {
      const uint32_t a = node.children, b = a + 1;
      const bool a_first =
          nodes[a].box.squaredExteriorDistance(point) <= nodes[b].box.squaredExteriorDistance(point);
      self(self, a_first ? a : b);
      self(self, a_first ? b : a);
      return;
    }
    for (const uint32_t i : tree_.items(node)) {
      const Triangle& t = mesh_->triangles[i];
      const Vec3 on =
          nearest_on_triangle(point, mesh_->positions[t[0]], mesh_->positions[t[1]], mesh_->positions[t[2]]);
      const double distance = (on - point).norm();
      if (distance < hit.distance) hit = {on, distance, i};
    }
  };
  visit(visit, 0);
  return hit;
}

double TriangleTree::winding_number(const Vec3& point) const {
  if (dipoles_.empty()) return 0;
  double angle = 0;
  const auto visit = [&](const auto& self, uint32_t n) -> void {
    const BoxTree::Node& node = tree_.nodes()[n];
    const Dipole& dipole = dipoles_[n];
    const Vec3 away = dipole.centre - point;
    const double distance = away.norm();
    if (node.children && distance <= kFar * dipole.radius) {
      self(self, node.children);
      self(self, node.children + 1);
      return;
    }
    if (distance > kFar * dipole.radius) {
      angle += away.dot(dipole.area_vector) / (distance * distance * distance);
      return;
    }
    for (const uint32_t i : tree_.items(node)) {
      const Triangle& t = mesh_->triangles[i];
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
