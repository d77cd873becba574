// A tree of boxes over many small things, for asking what is near a point.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

class BoxTree {
 public:
  explicit BoxTree(std::vector<Eigen::AlignedBox3d> boxes);

  /// Calls body(item) for every item whose box is within `reach` of the point.
  template <class Body>
  void near(const Vec3& point, double reach, Body body) const {
    if (nodes_.empty()) return;
    uint32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (node.box.squaredExteriorDistance(point) > reach * reach) continue;
      if (node.count > 0) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
          if (boxes_[items_[i]].squaredExteriorDistance(point) <= reach * reach) body(items_[i]);
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    uint32_t first = 0, count = 0;  // items of a leaf, or count 0 and the first of two children
  };
  void build(uint32_t node, uint32_t first, uint32_t count);

  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<uint32_t> items_;
  std::vector<Node> nodes_;
};

}  // namespace liana
