#include "runtime/wind/steady_gust_wind.h"

#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/random.h"

namespace liana {

SteadyGustWind::SteadyGustWind(const GustParameters& p) : mean_(p.mean) {
  const bool sound = p.mean.allFinite() && p.intensity >= 0 && p.across >= 0 && p.low_frequency > 0 &&
                     p.high_frequency > p.low_frequency && p.peak_frequency > 0 && p.spread >= 0 &&
                     std::isfinite(p.intensity + p.across + p.high_frequency + p.peak_frequency + p.spread) &&
                     p.mean.norm() < 200;
  if (!sound)
    throw Error(Error::Kind::Input, "the wind's parameters are not finite, negative or out of order",
                "a mean below 200 m/s, intensity >= 0 and 0 < low_frequency < high_frequency");
  const double speed = p.mean.norm();
  if (speed == 0 || p.waves == 0 || p.intensity == 0) return;

  const Vec3 along = p.mean / speed, side = along.unitOrthogonal(), up = along.cross(side);
  Random random(p.seed, "wind/gusts");
  // Frequencies evenly spread on a log scale, each somewhere in its own interval, so that the sum never
  // repeats; the power per interval is f/f₀ / (1 + f/f₀)^(5/3), Kaimal's shape of the atmospheric surface
  // layer.
  double power = 0;
  std::vector<double> root_power;
  for (unsigned i = 0; i < p.waves; ++i) {
    const double place = (i + random.uniform()) / p.waves;
    const double frequency = p.low_frequency * std::pow(p.high_frequency / p.low_frequency, place);
    const double ratio = frequency / p.peak_frequency, share = ratio / std::pow(1 + ratio, 5.0 / 3);
    power += share;
    root_power.push_back(std::sqrt(share));
    const double omega = 2 * kPi * frequency, wave = omega / speed;
    const double upward = random.normal(), sideward = random.normal();  // in this order with every compiler
    const Vec3 oblique = wave * (along + p.spread * (sideward * side + upward * up));
    const double turn = random.uniform(0, 2 * kPi);
    const Vec3 crosswise = p.across * std::sqrt(2.0) * (std::cos(turn) * side + std::sin(turn) * up);
    waves_.push_back({along + crosswise, oblique, omega, random.uniform(0, 2 * kPi)});
  }
  // A cosine has half its squared amplitude as variance. Sideways and upward parts share p.across² each.
  const double scale = p.intensity * speed * std::sqrt(2 / power);
  for (unsigned i = 0; i < p.waves; ++i) waves_[i].amplitude *= scale * root_power[i];
}

Vec3 SteadyGustWind::velocity(const Vec3& position, double time) const {
  Vec3 sum = mean_;
  for (const Wave& w : waves_) sum += w.amplitude * std::cos(w.wave.dot(position) - w.omega * time + w.phase);
  return sum;
}

}  // namespace liana
