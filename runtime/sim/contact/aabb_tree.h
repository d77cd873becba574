// Which of many small boxes overlap, when neighbours in their order are neighbours in space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesher/base/archive.h"
#include "mesher/base/types.h"

namespace liana {

/// Axis-parallel, m. Single precision, rounded outwards by whoever makes it. The fourth number of each corner
/// is nothing: four are compared at once.
struct alignas(32) Aabb {
  using Corner = float __attribute__((vector_size(16)));
  Corner low, high;
  bool overlaps(const Aabb& other) const { return every((low <= other.high) & (other.low <= high)); }
  bool contains(const Aabb& other) const { return every((low <= other.low) & (other.high <= high)); }

 private:
  using Answers = int32_t __attribute__((vector_size(16)));
  static bool every(Answers yes) {
    using Halves = int64_t __attribute__((vector_size(16)));
    const auto halves = reinterpret_cast<Halves>(yes);
    return (halves[0] & halves[1]) == -1;
  }
};

template <>
inline constexpr bool kPlainBytes<Aabb> = true;

/// A binary tree over the boxes in their order, groups of four at its ends: made anew for moved boxes in one
/// pass over them. The order of what it finds is a function of the boxes alone. Keep it: it owns its memory.
class AabbTree {
 public:
  void fit(std::span<const Aabb> boxes);

  /// Calls visit(first, second), first < second, for every pair of boxes that overlap.
  template <class Visit>
  void pairs(const Visit& visit) const {
    if (!levels_.empty()) within(levels_.size() - 1, 0, visit);
  }
  /// Calls visit(other) for every box that overlaps the one with this number, itself included.
  template <class Visit>
  void overlaps_of(uint32_t number, const Visit& visit) const {
    if (!levels_.empty()) descend(levels_.size() - 1, 0, boxes_[number], visit);
  }

 private:
  static constexpr uint32_t kGroup = 4;

  template <class Visit>
  void within(size_t level, uint32_t node, const Visit& visit) const {
    if (level == 0) {
      const auto end = std::min<uint32_t>((node + 1) * kGroup, boxes_.size());
      for (uint32_t i = node * kGroup; i < end; ++i)
        for (uint32_t j = i + 1; j < end; ++j)
          if (boxes_[i].overlaps(boxes_[j])) visit(i, j);
      return;
    }
    within(level - 1, 2 * node, visit);
    if (2 * node + 1 >= levels_[level - 1].size()) return;
    within(level - 1, 2 * node + 1, visit);
    across(level - 1, 2 * node, 2 * node + 1, visit);
  }
  template <class Visit>
  void across(size_t level, uint32_t a, uint32_t b, const Visit& visit) const {
    const std::vector<Aabb>& nodes = levels_[level];
    if (!nodes[a].overlaps(nodes[b])) return;
    if (level == 0) {
      const auto end_b = std::min<uint32_t>((b + 1) * kGroup, boxes_.size());
      for (uint32_t i = a * kGroup; i < (a + 1) * kGroup; ++i) {
        if (!boxes_[i].overlaps(nodes[b])) continue;
        for (uint32_t j = b * kGroup; j < end_b; ++j)
          if (boxes_[i].overlaps(boxes_[j])) visit(i, j);
      }
      return;
    }
    const bool odd = 2 * b + 1 >= levels_[level - 1].size();
    for (const uint32_t x : {2 * a, 2 * a + 1})
      for (const uint32_t y : {2 * b, 2 * b + 1})
        if (y == 2 * b || !odd) across(level - 1, x, y, visit);
  }
  template <class Visit>
  void descend(size_t level, uint32_t node, const Aabb& box, const Visit& visit) const {
    if (!levels_[level][node].overlaps(box)) return;
    if (level == 0) {
      const auto end = std::min<uint32_t>((node + 1) * kGroup, boxes_.size());
      for (uint32_t i = node * kGroup; i < end; ++i)
        if (boxes_[i].overlaps(box)) visit(i);
      return;
    }
    for (const uint32_t child : {2 * node, 2 * node + 1})
      if (child < levels_[level - 1].size()) descend(level - 1, child, box, visit);
  }

  std::span<const Aabb> boxes_;
  std::vector<std::vector<Aabb>> levels_;  // of groups, of pairs of these, ... of all
};

}  // namespace liana
