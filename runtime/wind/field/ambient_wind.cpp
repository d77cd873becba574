#include "runtime/wind/field/ambient_wind.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/random.h"

namespace liana {

double von_karman_along(double n) {
  return 4 * n / fixed::pow(1 + 70.8 * n * n, 5.0 / 6);
}
double von_karman_across(double n) {
  return 4 * n * (1 + 755.2 * n * n) / fixed::pow(1 + 283.2 * n * n, 11.0 / 6);
}

namespace {

constexpr double kLowest = 0.002, kHighest = 80;  // n of the slowest and the fastest waves
constexpr double kFinest = 10;  // turns/m across the wind: finer than a leaf is not followed

/// Share of the variance between two values of n: ∫ f S/σ² d(ln f), Simpson's rule.
double variance_between(double (*spectrum)(double), double n0, double n1) {
  constexpr int kParts = 16;
  const double step = fixed::log(n1 / n0) / kParts;
  double sum = 0;
  for (int i = 0; i <= kParts; ++i)
    sum += (i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2) * spectrum(n0 * fixed::exp(i * step));
  return sum * step / 3;
}

}  // namespace

AmbientWind::AmbientWind(const AmbientParameters& p) : parameters_(p) {
  const double speed = p.mean.norm();
  const bool sound = p.mean.allFinite() && speed > 0 && speed < 200 && p.intensity >= 0 && p.intensity <= 2 &&
                     p.across >= 0 && p.up >= 0 && std::isfinite(p.across + p.up) && p.length_scale > 0 &&
                     std::isfinite(p.length_scale) && p.coherence_decay >= 0 && p.coherence_decay <= 1000 &&
                     p.frequencies > 0 && p.waves > 0 && size_t(p.frequencies) * p.waves <= WaveSum::kMost;
  if (!sound)
    throw Error(
        Error::Kind::Input, "the ambient wind's parameters are not finite or out of range",
        "a mean above 0 and below 200 m/s, intensity 0-2, a positive length scale, at most 512 waves");
  const Vec3 along = p.mean / speed;
  Vec3 side = along.cross(Vec3::UnitY());
  side = side.norm() > 1e-6 ? side.normalized() : along.unitOrthogonal();
  const Vec3 up = side.cross(along);

  Random random(p.seed, "wind/ambient");
  const double sigma = p.intensity * speed, per_length = speed / p.length_scale;
  const double step = fixed::pow(kHighest / kLowest, 1.0 / p.frequencies);
  for (unsigned i = 0; i < p.frequencies; ++i) {
    const double n0 = kLowest * fixed::pow(step, i), n1 = n0 * step;
    // A cosine has half its squared amplitude as variance.
    const double a = sigma * std::sqrt(2 * variance_between(von_karman_along, n0, n1) / p.waves);
    const double b = sigma * std::sqrt(2 * variance_between(von_karman_across, n0 / 2, n1 / 2) / p.waves);
    for (unsigned wave = 0; wave < p.waves; ++wave) {
      const double frequency = n0 * fixed::pow(step, random.uniform()) * per_length;
      const double scale = p.coherence_decay * frequency / (2 * kPi * speed);
      const double y = random.normal(), z = random.normal(), over = std::abs(random.normal());
      Vec3 across = scale / std::max(over, 1e-9) * (y * side + z * up);
      if (across.norm() > kFinest) across *= kFinest / across.norm();
      const double v_sign = random.uniform() < 0.5 ? -1 : 1, w_sign = random.uniform() < 0.5 ? -1 : 1;
      waves_.add(frequency / speed * along + across, frequency, random.uniform(),
                 a * along + b * (v_sign * p.across * side + w_sign * p.up * up));
    }
  }
}

Vec3 AmbientWind::velocity(const Vec3& position, double time) const {
  Vec3 out;
  velocities({&position, 1}, time, {&out, 1});
  return out;
}

void AmbientWind::velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
  std::fill(out.begin(), out.end(), parameters_.mean);
  waves_.add_to(positions, time, out);
}

}  // namespace liana
