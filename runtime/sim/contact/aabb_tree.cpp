#include "runtime/sim/contact/aabb_tree.h"

namespace liana {
namespace {

/// Of every `count` boxes in turn, the box around them.
void enclose(std::span<const Aabb> boxes, uint32_t count, std::vector<Aabb>& around) {
  around.resize((boxes.size() + count - 1) / count);
  for (size_t i = 0; i < around.size(); ++i) {
    around[i] = boxes[i * count];
    for (size_t j = i * count + 1; j < std::min(boxes.size(), (i + 1) * count); ++j) {
      around[i].low = around[i].low < boxes[j].low ? around[i].low : boxes[j].low;
      around[i].high = around[i].high > boxes[j].high ? around[i].high : boxes[j].high;
    }
  }
}

}  // namespace

void AabbTree::fit(std::span<const Aabb> boxes) {
  boxes_ = boxes;
  size_t levels = 0;
  if (!boxes.empty()) {
    const auto level = [&]() -> std::vector<Aabb>& {
      if (levels == levels_.size()) levels_.emplace_back();
      return levels_[levels++];
    };
    enclose(boxes, kGroup, level());
    while (levels_[levels - 1].size() > 1) {
      std::vector<Aabb>& next = level();
      enclose(levels_[levels - 2], 2, next);
    }
  }
  levels_.resize(levels);
}

}  // namespace liana
