#include "runtime/wind/air/air_cells.h"

#include <utility>

namespace liana {

AirCells::AirCells(const Vec3& extent, double support, size_t capacity) : extent_(extent.cast<float>()) {
  double cell = support, number;
  do {
    number = 1;
    for (int k = 0; k < 3; ++k) number *= number_[k] = static_cast<int>(std::ceil(extent[k] / cell)) + 2;
    width_ = static_cast<float>(cell);
    cell *= 1.25;
  } while (number > std::max<double>(16384, 2.0 * static_cast<double>(capacity)));
  begin_.resize(static_cast<size_t>(number) + 2);
  const size_t padded = capacity + 16;
  key_.resize(padded), x_.resize(padded), y_.resize(padded), z_.resize(padded);
}

size_t AirCells::sort(const AirState* state, size_t count, AirState* sorted) {
  const auto outside = static_cast<uint32_t>(size());
  std::fill(begin_.begin(), begin_.end(), 0u);
  const float per_cell = 1 / width_;
  for (size_t i = 0; i < count; ++i) {
    const AirState& a = state[i];
    const bool inside = a.x >= 0 && a.x < extent_.x() && a.y >= 0 && a.y < extent_.y() && a.z >= 0 &&
                        a.z < extent_.z() && std::abs(a.vx + a.vy + a.vz) < kFar;
    uint32_t key = outside;
    if (inside)
      key = (1 + static_cast<uint32_t>(a.x * per_cell)) +
            number_[0] * ((1 + static_cast<uint32_t>(a.y * per_cell)) +
                          number_[1] * (1 + static_cast<uint32_t>(a.z * per_cell)));
    key_[i] = key;
    ++begin_[key];
  }
  uint32_t sum = 0;
  for (uint32_t& begin : begin_) sum += std::exchange(begin, sum);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t to = begin_[key_[i]]++;
    const AirState& a = state[i];
    sorted[to] = a;
    x_[to] = a.x, y_[to] = a.y, z_[to] = a.z;
  }
  // Each begin has moved to its end, which is the next one's begin.
  for (size_t k = begin_.size() - 1; k > 0; --k) begin_[k] = begin_[k - 1];
  begin_[0] = 0;
  const size_t left = begin_[outside];
  for (size_t i = left; i < left + 8; ++i) x_[i] = y_[i] = z_[i] = kFar;
  return left;
}

}  // namespace liana
