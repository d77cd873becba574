#include "runtime/wind/air/emitter.h"

#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/random.h"

namespace liana {
namespace {

AmbientParameters eddies_of(const EmitterParameters& p, uint64_t seed) {
  const bool sound =
      p.center.allFinite() && p.direction.allFinite() && p.direction.norm() > 1e-9 && p.speed > 0 &&
      p.speed <= 100 && p.turbulence >= 0 && p.turbulence <= 1 && p.gust >= 0 && p.gust <= 1 &&
      p.gust_period > 0 && std::isfinite(p.gust_period) &&
      (p.shape == EmitterParameters::Shape::Disc ? p.radius > 0 && p.radius < 1e3
                                                 : p.width > 0 && p.height > 0 && p.width + p.height < 1e3);
  if (!sound)
    throw Error(Error::Kind::Input,
                "a wind emitter's speed, size, direction, turbulence or gusts are out of range",
                "a speed above 0 and up to 100 m/s, a positive size, turbulence and gust between 0 and 1");
  AmbientParameters eddies;
  eddies.mean = p.speed * p.direction.normalized();
  eddies.intensity = p.turbulence;
  eddies.across = eddies.up = 1;
  eddies.length_scale = p.turbulence_length;
  eddies.frequencies = 32;
  eddies.waves = 2;
  eddies.seed = seed;
  return eddies;
}

}  // namespace

Emitter::Emitter(const EmitterParameters& parameters, uint64_t seed)
    : parameters_(parameters), eddies_(eddies_of(parameters, seed)) {
  const Vec3 ahead = parameters.direction.normalized();
  Vec3 across = ahead.cross(Vec3::UnitY());
  across = across.norm() > 1e-6 ? across.normalized() : ahead.unitOrthogonal();
  axes_ << ahead, across, across.cross(ahead);
  Random random(seed, "wind/emitter");
  for (double& phase : gust_phase_) phase = random.uniform(0, 2 * kPi);
}

// Three waves whose periods have no common multiple; the variance of each is a third.
double Emitter::gust_at(double time) const {
  if (parameters_.gust == 0) return 1;
  double sum = 0;
  const double faster[3] = {1, 1.618034, 2.732051};
  for (int i = 0; i < 3; ++i)
    sum += fixed::sin(2 * kPi * faster[i] * time / parameters_.gust_period + gust_phase_[i]);
  return std::max(0.0, 1 + parameters_.gust * std::sqrt(2.0 / 3) * sum);
}

bool Emitter::contains(double across, double up) const {
  const EmitterParameters& p = parameters_;
  return p.shape == EmitterParameters::Shape::Disc
             ? across * across + up * up <= p.radius * p.radius
             : std::abs(across) <= p.width / 2 && std::abs(up) <= p.height / 2;
}

size_t Emitter::emit(SphAir& air, double time, double dt) {
  const double s = air.options().spacing, gust = gust_at(time);
  const bool disc = parameters_.shape == EmitterParameters::Shape::Disc;
  const double half_width = disc ? parameters_.radius : parameters_.width / 2,
               half_height = disc ? parameters_.radius : parameters_.height / 2;
  const double flow = parameters_.speed * gust;
  for (size_t i = 0; i < air.size(); ++i) {
    const Vec3 place = air.position(i) - parameters_.center;
    const double ahead = place.dot(axes_.col(0));
    if (ahead < 0 || ahead >= s || !contains(place.dot(axes_.col(1)), place.dot(axes_.col(2)))) continue;
    air.push(i, axes_.col(0) * std::max(0.0, flow - air.velocity(i).dot(axes_.col(0))));
  }
  size_t refused = 0;
  for (due_ += flow * dt; due_ >= s; due_ -= s, ++layers_) {
    const double shift = layers_ % 2 == 0 ? 0 : s / 2;
    const auto columns = static_cast<int>(half_width / s) + 1, rows = static_cast<int>(half_height / s) + 1;
    for (int row = -rows; row <= rows; ++row)
      for (int column = -columns; column <= columns; ++column) {
        const double u = column * s + shift, v = row * s + shift;
        if (!contains(u, v)) continue;
        const Vec3 place = parameters_.center + axes_ * Vec3(due_ - s, u, v);
        refused += !air.add(place, gust * eddies_.velocity(place, time));
      }
  }
  return refused;
}

}  // namespace liana
