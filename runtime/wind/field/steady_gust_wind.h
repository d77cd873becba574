// A steady wind with gusts that travel with it.
#pragma once

#include "runtime/wind/field/wave_sum.h"
#include "runtime/wind/field/wind_field.h"

namespace liana {

struct GustParameters {
  Vec3 mean = {1.5, 0, 0};       ///< m/s
  double intensity = 0.3;        ///< standard deviation of the wind along its direction, over the mean speed
  double across = 0.6;           ///< the same sideways and up, over the one along
  double low_frequency = 0.03;   ///< Hz, the slowest gusts
  double high_frequency = 1.5;   ///< Hz, the fastest
  double peak_frequency = 0.15;  ///< Hz, where the gusts are strongest
  double spread = 0.7;           ///< how oblique the gust fronts run: 0 = all plane across the wind
  unsigned waves = 24;
  uint64_t seed = 1;
};

/// A sum of travelling waves with frozen amplitudes: u(x, t) = U + Σ a cos(k·x - ωt + φ), with k·Û = ω/|U|,
/// so that a gust is carried past at the mean speed (Taylor's frozen turbulence). Smooth in place and time, a
/// pure function of its parameters.
class SteadyGustWind : public WindField {
 public:
  /// Throws Error{Input} for values that are not finite or out of range.
  explicit SteadyGustWind(const GustParameters& parameters = {});
  Vec3 velocity(const Vec3& position, double time) const override;
  void velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const override;

 private:
  Vec3 mean_;
  WaveSum waves_;
};

}  // namespace liana
