// A sum of travelling waves, eight at a time: what winds without particles are made of.
#pragma once

#include <span>
#include <vector>

#include "mesher/base/types.h"

namespace liana {

/// u(x, t) = Σ a cos(2π (κ·x − f t + φ)), in single precision: within 1e-4 Σ|a| as long as κ·x stays below
/// some hundred turns. The same bits on every machine.
class WaveSum {
 public:
  static constexpr size_t kMost = 512;
  /// κ in turns/m, f in Hz, φ in turns, a in m/s.
  void add(const Vec3& turns, double frequency, double phase, const Vec3& amplitude);
  /// Adds u to each of `out`. Allocates nothing.
  void add_to(std::span<const Vec3> positions, double time, std::span<Vec3> out) const;

 private:
  size_t count_ = 0;
  std::vector<float> kx_, ky_, kz_, ax_, ay_, az_;  // padded with zeros to a multiple of 8
  std::vector<double> frequency_, phase_;
};

}  // namespace liana
