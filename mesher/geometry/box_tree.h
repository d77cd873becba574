// A tree of boxes over many small things: what is near a point, and which of them meet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

/// Built in n log n. Each node's items are halved by the order of their boxes' middles along the longest
/// axis, so that the depth is that of a balanced tree.
class BoxTree {
 public:
  struct Node {
    Eigen::AlignedBox3d box;
    uint32_t begin = 0, end = 0;  // of items
    uint32_t children = 0;        // number of the first, the second follows; 0 for a leaf
  };

  BoxTree() = default;
  /// Leaves hold up to `leaf` items.
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes, uint32_t leaf = 4);

  const std::vector<Node>& nodes() const { return nodes_; }  ///< parents first; none if there are no items
  std::span<const uint32_t> items(const Node& node) const {
    return std::span(items_).subspan(node.begin, node.end - node.begin);
  }

  /// Calls body(item) for every item whose box is within `reach` of the point.
  template <class Body>
  void near(const Vec3& point, double reach, Body body) const {
    if (!nodes_.empty()) near(0, point, reach * reach, body);
  }

  /// Calls body(a, b) for pairs of items whose boxes meet until it says true; false if it never does.
  template <class Body>
  bool any_pair(Body body) const {
    return !nodes_.empty() && pairs_within(0, body);
  }

 private:
  void build(uint32_t node, uint32_t leaf);

  template <class Body>
  void near(uint32_t n, const Vec3& point, double square, Body& body) const {
    const Node& node = nodes_[n];
    if (node.box.squaredExteriorDistance(point) > square) return;
    if (node.children) {
      near(node.children, point, square, body);
      near(node.children + 1, point, square, body);
      return;
    }
    for (const uint32_t i : items(node))
      if (boxes_[i].squaredExteriorDistance(point) <= square) body(i);
  }

  template <class Body>
  bool pairs_within(uint32_t n, Body& body) const {
    const Node& node = nodes_[n];
    if (node.children)
      return pairs_within(node.children, body) || pairs_within(node.children + 1, body) ||
             pairs_between(node.children, node.children + 1, body);
    for (uint32_t i = node.begin; i < node.end; ++i)
      for (uint32_t k = i + 1; k < node.end; ++k)
        if (boxes_[items_[i]].intersects(boxes_[items_[k]]) && body(items_[i], items_[k])) return true;
    return false;
  }

  template <class Body>
  bool pairs_between(uint32_t first, uint32_t second, Body& body) const {
    const Node &a = nodes_[first], &b = nodes_[second];
    if (!a.box.intersects(b.box)) return false;
    if (a.children && (!b.children || a.end - a.begin >= b.end - b.begin))
      return pairs_between(a.children, second, body) || pairs_between(a.children + 1, second, body);
    if (b.children)
      return pairs_between(first, b.children, body) || pairs_between(first, b.children + 1, body);
    for (const uint32_t i : items(a)) {
      if (!boxes_[i].intersects(b.box)) continue;
      for (const uint32_t k : items(b))
        if (boxes_[i].intersects(boxes_[k]) && body(i, k)) return true;
    }
    return false;
  }

  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<uint32_t> items_;
  std::vector<Node> nodes_;
};

}  // namespace liana
