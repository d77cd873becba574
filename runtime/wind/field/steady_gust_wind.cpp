#include "runtime/wind/field/steady_gust_wind.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/random.h"

namespace liana {

SteadyGustWind::SteadyGustWind(const GustParameters& p) : mean_(p.mean) {
  const bool sound = p.mean.allFinite() && p.intensity >= 0 && p.across >= 0 && p.low_frequency > 0 &&
                     p.high_frequency > p.low_frequency && p.peak_frequency > 0 && p.spread >= 0 &&
                     std::isfinite(p.intensity + p.across + p.high_frequency + p.peak_frequency + p.spread) &&
                     p.mean.norm() < 200 && p.waves <= WaveSum::kMost;
  if (!sound)
    throw Error(
        Error::Kind::Input, "the wind's parameters are not finite, negative or out of order",
        "a mean below 200 m/s, intensity >= 0, 0 < low_frequency < high_frequency, at most 512 waves");
  const double speed = p.mean.norm();
  if (speed == 0 || p.waves == 0 || p.intensity == 0) return;

  const Vec3 along = p.mean / speed, side = along.unitOrthogonal(), up = along.cross(side);
  Random random(p.seed, "wind/gusts");
  // Frequencies evenly spread on a log scale, each somewhere in its own interval, so that the sum never
  // repeats; the power per interval is f/f₀ / (1 + f/f₀)^(5/3), Kaimal's shape of the atmospheric surface
  // layer.
  double power = 0;
  std::vector<double> frequencies, root_power;
  for (unsigned i = 0; i < p.waves; ++i) {
    const double place = (i + random.uniform()) / p.waves;
    frequencies.push_back(p.low_frequency * fixed::pow(p.high_frequency / p.low_frequency, place));
    const double ratio = frequencies.back() / p.peak_frequency,
                 share = ratio / fixed::pow(1 + ratio, 5.0 / 3);
    power += share;
    root_power.push_back(std::sqrt(share));
  }
  // A cosine has half its squared amplitude as variance. Sideways and upward parts share p.across² each.
  const double scale = p.intensity * speed * std::sqrt(2 / power);
  for (unsigned i = 0; i < p.waves; ++i) {
    const double upward = random.normal(), sideward = random.normal();  // in this order with every compiler
    const Vec3 oblique = frequencies[i] / speed * (along + p.spread * (sideward * side + upward * up));
    const double turn = random.uniform(0, 2 * kPi);
    const Vec3 crosswise = p.across * std::sqrt(2.0) * (fixed::cos(turn) * side + fixed::sin(turn) * up);
    waves_.add(oblique, frequencies[i], random.uniform(), scale * root_power[i] * (along + crosswise));
  }
}

Vec3 SteadyGustWind::velocity(const Vec3& position, double time) const {
  Vec3 out;
  velocities({&position, 1}, time, {&out, 1});
  return out;
}

void SteadyGustWind::velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
  std::fill(out.begin(), out.end(), mean_);
  waves_.add_to(positions, time, out);
}

}  // namespace liana
