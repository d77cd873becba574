#include "mesher/geometry/box_tree.h"

#include <algorithm>
#include <numeric>

namespace liana {

BoxTree::BoxTree(std::vector<Eigen::AlignedBox3d> boxes, uint32_t leaf)
    : boxes_(std::move(boxes)), items_(boxes_.size()) {
  if (items_.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(2 * items_.size());
  nodes_.push_back({.box = {}, .begin = 0, .end = static_cast<uint32_t>(items_.size())});
  for (uint32_t n = 0; n < nodes_.size(); ++n) build(n, leaf);
}

void BoxTree::build(uint32_t n, uint32_t leaf) {
  Node& node = nodes_[n];
  Eigen::AlignedBox3d middles;
  for (const uint32_t i : items(node)) {
    node.box.extend(boxes_[i]);
    middles.extend(boxes_[i].center());
  }
  const uint32_t begin = node.begin, end = node.end, half = begin + (end - begin) / 2;
  if (end - begin <= leaf) return;
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     const double ca = boxes_[a].center()[axis], cb = boxes_[b].center()[axis];
                     return ca < cb || (ca == cb && a < b);
                   });
  node.children = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({.box = {}, .begin = begin, .end = half});
  nodes_.push_back({.box = {}, .begin = half, .end = end});
}

}  // namespace liana
