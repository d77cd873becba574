#include "mesher/geometry/box_tree.h"

#include <algorithm>
#include <numeric>

namespace liana {

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), 0u);
  if (boxes_.empty()) return;
  nodes_.reserve(boxes_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(items_.size()));
}

// Halves by the middle of the longest axis' order: the depth is that of a balanced tree.
void BoxTree::build(uint32_t node, uint32_t first, uint32_t count) {
  Eigen::AlignedBox3d box, middles;
  for (uint32_t i = first; i < first + count; ++i) {
    box.extend(boxes_[items_[i]]);
    middles.extend(boxes_[items_[i]].center());
  }
  nodes_[node].box = box;
  if (count <= 4) {
    nodes_[node].first = first, nodes_[node].count = count;
    return;
  }
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const uint32_t half = count / 2;
  std::nth_element(items_.begin() + first, items_.begin() + first + half, items_.begin() + first + count,
                   [&](uint32_t a, uint32_t b) {
                     const double ca = boxes_[a].center()[axis], cb = boxes_[b].center()[axis];
                     return ca < cb || (ca == cb && a < b);
                   });
  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.emplace_back(), nodes_.emplace_back();
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

}  // namespace liana
