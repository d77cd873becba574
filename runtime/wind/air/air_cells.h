// Air particles sorted into the cells of a grid, so that neighbours in space are neighbours in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesher/base/types.h"
#include "runtime/wind/air/sph_pass.h"

namespace liana {

class AirCells {
 public:
  static constexpr float kFar =
      1e18f;  // m: where padding is, out of reach of all, and its square still a float

  /// Of a domain of this extent (m), with an empty border. As wide as the support (m); wider in a domain so
  /// large that most would stand empty.
  AirCells(const Vec3& extent, double support, size_t capacity);

  /// A stable counting sort of `count` particles into `sorted`, which also takes out who left the domain (or
  /// is no longer a number). Returns how many are left.
  size_t sort(const AirState* state, size_t count, AirState* sorted);

  size_t size() const { return begin_.size() - 2; }
  float width() const { return width_; }              ///< m
  const int (&number() const)[3] { return number_; }  ///< along each axis
  uint32_t begin(size_t cell) const {
    return begin_[cell];
  }  ///< its first particle; of size(): how many there are
  /// Which cell along an axis a place (m, from the low corner) is in; outside, one of the border.
  int along(float x, int axis) const {
    return 1 +
           static_cast<int>(std::clamp(std::floor(x / width_), -1.0f, static_cast<float>(number_[axis] - 2)));
  }
  /// The runs of particles in the nine rows of cells around one.
  void runs_around(uint32_t cell, uint32_t (&run_begin)[9], uint32_t (&run_end)[9]) const {
    for (int run = 0; run < 9; ++run) {
      const uint32_t row = cell + number_[0] * (run % 3 - 1 + number_[1] * (run / 3 - 1));
      run_begin[run] = begin_[row - 1], run_end[run] = begin_[row + 2];
    }
  }
  /// The particles in the cells that a box (m, from the low corner) touches: calls visit(first, last) for
  /// ranges.
  template <class Visit>
  void for_ranges(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const Visit& visit) const {
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) first[k] = along(low[k], k), last[k] = along(high[k], k);
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y) {
        const size_t row = size_t(number_[0]) * (y + size_t(number_[1]) * z);
        const uint32_t begin = begin_[row + first[0]], end = begin_[row + last[0] + 1];
        if (begin < end) visit(begin, end);
      }
  }

  const float* xs() const { return x_.data(); }  ///< of all particles, m from the low corner; padded by 8
  const float* ys() const { return y_.data(); }
  const float* zs() const { return z_.data(); }

 private:
  Eigen::Vector3f extent_;
  float width_ = 0;
  int number_[3] = {0, 0, 0};
  std::vector<uint32_t> key_, begin_;
  std::vector<float> x_, y_, z_;
};

}  // namespace liana
