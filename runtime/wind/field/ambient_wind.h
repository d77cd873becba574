// The turbulent wind of the atmosphere, without particles: von Kármán's spectra, Davenport's coherence.
//
//   U  mean speed, m/s                    n  f L / U with L of the component
//   f  frequency, Hz                      σ  standard deviation of a component, m/s
//   L  length scale of the turbulence, m  Δ  distance of two points across the wind, m
//
//   along the wind   f S_u / σ_u² = 4 n / (1 + 70.8 n²)^(5/6)                       [von Kármán 1948]
//   across it        f S_v / σ_v² = 4 n (1 + 755.2 n²) / (1 + 283.2 n²)^(11/6)      the isotropic
//   counterpart, L/2 coherence        co-spectrum of two points over the spectrum = exp(−C f Δ / U)
//   [Davenport 1961]
#pragma once

#include "runtime/wind/field/wave_sum.h"
#include "runtime/wind/field/wind_field.h"

namespace liana {

struct AmbientParameters {
  Vec3 mean = {4, 0, 0};        ///< m/s, not zero
  double intensity = 0.25;      ///< σ_u / U
  double across = 0.75;         ///< σ_v / σ_u
  double up = 0.5;              ///< σ_w / σ_u
  double length_scale = 25;     ///< L_u, m: some tens of metres in the open
  double coherence_decay = 10;  ///< C
  unsigned frequencies = 48;    ///< evenly spread on a log scale over 98 % of the variance
  unsigned waves = 3;           ///< of each frequency, in different directions
  uint64_t seed = 1;

  template <class Archive>
  void persist(Archive& a) {
    a(mean, intensity, across, up, length_scale, coherence_decay, frequencies, waves, seed);
  }
};

/// f S / σ² at n = f L / U.
double von_karman_along(double n);
double von_karman_across(double n);

/// A sum of travelling waves u = U + Σ a cos(2π (κ·x − f t) + φ). Along the wind κ = f/U (Taylor's frozen
/// turbulence); across it κ is drawn from the two-dimensional Cauchy distribution of scale C f/(2π U), whose
/// characteristic function is exp(−C f Δ/U): Davenport's coherence is the mean over all waves by
/// construction. A pure function of its parameters, the same on every machine.
class AmbientWind : public WindField {
 public:
  /// Throws Error{Input} for values that are not finite or out of range.
  explicit AmbientWind(const AmbientParameters& parameters = {});
  Vec3 velocity(const Vec3& position, double time) const override;
  void velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const override;

 private:
  AmbientParameters parameters_;
  WaveSum waves_;
};

}  // namespace liana
