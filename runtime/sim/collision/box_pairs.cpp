#include "runtime/sim/collision/box_pairs.h"

#include <bit>

namespace liana {

void BoxPairs::sort_into_cells(std::span<const FlatBox> boxes) {
  large_.clear();
  entries_.clear();
  double sum = 0;
  for (const FlatBox& b : boxes) sum += (b.high - b.low).maxCoeff();
  const float cell = boxes.empty() ? 1.0f : static_cast<float>(std::max(1e-3, 1.5 * sum / boxes.size()));
  per_cell_ = 1 / cell;
  mask_ = static_cast<uint32_t>(std::bit_ceil(2 * boxes.size() + 2)) - 1;
  first_.assign(mask_ + 2, 0);
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    const Cell low = cell_of(boxes[i].low), high = cell_of(boxes[i].high);
    const auto across = (high - low).cast<int64_t>().array() + 1;
    if ((across > 64).any() || across.prod() > 64) {
      large_.push_back(i);
      continue;
    }
    Cell c;
    for (c.z() = low.z(); c.z() <= high.z(); ++c.z())
      for (c.y() = low.y(); c.y() <= high.y(); ++c.y())
        for (c.x() = low.x(); c.x() <= high.x(); ++c.x()) {
          entries_.push_back({c, i});
          ++first_[bucket_of(c) + 1];
        }
  }
  for (size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  sorted_.resize(entries_.size());
  for (const Entry& entry : entries_) sorted_[first_[bucket_of(entry.cell)]++] = entry;
  for (size_t k = first_.size() - 1; k > 0; --k) first_[k] = first_[k - 1];
  first_[0] = 0;
}

}  // namespace liana
