// Sets that merge.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace liana {

class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  uint32_t find(uint32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// The set of the smaller representative takes the other in.
  void unite(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    parent_[a < b ? b : a] = a < b ? a : b;
  }
  /// Per item the number of its set, numbered from 0 in order of first item.
  std::vector<uint32_t> numbered(uint32_t* count) {
    std::vector<uint32_t> number(parent_.size());
    *count = 0;
    for (uint32_t i = 0; i < parent_.size(); ++i) number[i] = find(i) == i ? (*count)++ : number[find(i)];
    return number;
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace liana
