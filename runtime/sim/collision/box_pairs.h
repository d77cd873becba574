// Which of many small boxes overlap: cells sorted by counting, no grid over empty space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

/// Axis-parallel, m. Single precision, rounded outwards by whoever makes it.
struct FlatBox {
  Eigen::Vector3f low, high;
  bool meets(const FlatBox& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Owns the working memory: keep it. Every box is entered in the cells that it overlaps; boxes far larger
/// than most (trunks) are held against all others instead. The order of the pairs is a function of the boxes
/// alone.
class BoxPairs {
 public:
  using Pair = std::pair<uint32_t, uint32_t>;  ///< first < second

  /// Appends every pair of boxes that overlap and for which wanted(first, second).
  template <class Wanted>
  void find(std::span<const FlatBox> boxes, const Wanted& wanted, std::vector<Pair>& pairs);

 private:
  struct Entry {
    Eigen::Vector3i cell;
    uint32_t box;
  };
  using Cell = Eigen::Vector3i;
  Cell cell_of(const Eigen::Vector3f& x) const { return (x * per_cell_).array().floor().cast<int>(); }
  size_t bucket_of(const Cell& c) const {
    const auto hash = static_cast<uint32_t>(c.x()) * 0x8da6b343u +
                      static_cast<uint32_t>(c.y()) * 0xd8163841u + static_cast<uint32_t>(c.z()) * 0xcb1ab31fu;
    return (hash ^ hash >> 15) & mask_;
  }
  void sort_into_cells(std::span<const FlatBox> boxes);

  float per_cell_ = 1;  // 1/m
  uint32_t mask_ = 0;
  std::vector<uint32_t> first_;  // of each bucket, into sorted_
  std::vector<Entry> entries_, sorted_;
  std::vector<uint32_t> large_;
};

template <class Wanted>
void BoxPairs::find(std::span<const FlatBox> boxes, const Wanted& wanted, std::vector<Pair>& pairs) {
  sort_into_cells(boxes);
  const auto offer = [&](uint32_t a, uint32_t b) {
    const Pair pair = std::minmax(a, b);
    if (wanted(pair.first, pair.second)) pairs.push_back(pair);
  };
  for (size_t k = 0; k + 1 < first_.size(); ++k)
    for (uint32_t i = first_[k]; i < first_[k + 1]; ++i)
      for (uint32_t j = i + 1; j < first_[k + 1]; ++j) {
        const Entry &a = sorted_[i], &b = sorted_[j];
        if (a.cell != b.cell || !boxes[a.box].meets(boxes[b.box])) continue;
        // Both may lie in several cells: the one with the low corner of what they share counts.
        if (cell_of(boxes[a.box].low.cwiseMax(boxes[b.box].low)) == a.cell) offer(a.box, b.box);
      }
  for (size_t i = 0; i < large_.size(); ++i) {
    for (uint32_t other = 0; other < boxes.size(); ++other) {
      // Two large ones meet once, at the earlier.
      const bool met =
          std::binary_search(large_.begin(), large_.begin() + static_cast<ptrdiff_t>(i) + 1, other);
      if (!met && boxes[large_[i]].meets(boxes[other])) offer(large_[i], other);
    }
  }
}

}  // namespace liana
