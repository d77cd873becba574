#include "runtime/wind/ambient_wind.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/random.h"
#include "runtime/wind/simd8.h"

namespace liana {

double von_karman_along(double n) {
  return 4 * n / std::pow(1 + 70.8 * n * n, 5.0 / 6);
}
double von_karman_across(double n) {
  return 4 * n * (1 + 755.2 * n * n) / std::pow(1 + 283.2 * n * n, 11.0 / 6);
}

/// One number per wave and array, `count` of them, a multiple of 8.
struct AmbientWind::Waves {
  const float *kx, *ky, *kz, *phase;  // turns/m; turns
  const float *ax, *ay, *az;          // m/s
  size_t count;
};

namespace {

constexpr double kLowest = 0.002, kHighest = 80;  // n of the slowest and the fastest waves
constexpr double kFinest = 10;  // turns/m across the wind: finer than a leaf is not followed

/// Share of the variance between two values of n: ∫ f S/σ² d(ln f), Simpson's rule.
double variance_between(double (*spectrum)(double), double n0, double n1) {
  constexpr int kParts = 16;
  const double step = std::log(n1 / n0) / kParts;
  double sum = 0;
  for (int i = 0; i <= kParts; ++i)
    sum += (i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2) * spectrum(n0 * std::exp(i * step));
  return sum * step / 3;
}

__attribute__((always_inline)) inline Float8 loaded(const float* p) {
  return *reinterpret_cast<const Float8Loose*>(p);
}

/// Σ a cos(2π (κ·x + phase)), eight waves at a time: sine's series to x¹¹ on a quarter turn, good to 6e-8.
__attribute__((always_inline)) inline void sum_waves(const AmbientWind::Waves& w, const float (&x)[3],
                                                     float (&out)[3]) {
  Float8 u = {}, v = {}, s = {};
  for (size_t i = 0; i < w.count; i += 8) {
    const Float8 turns =
        loaded(w.kx + i) * x[0] + loaded(w.ky + i) * x[1] + loaded(w.kz + i) * x[2] + loaded(w.phase + i);
    const Float8 rounded = (turns + 12582912.0f) - 12582912.0f;  // 1.5 · 2²³: to the nearest integer
    const Float8 part = turns - rounded, side = part > 0 ? part : -part;
    const Float8 angle = (0.25f - side) * 6.28318531f, a2 = angle * angle;
    const Float8 cosine =
        angle * (1 + a2 * (-1.6666667e-1f +
                           a2 * (8.3333333e-3f +
                                 a2 * (-1.9841270e-4f + a2 * (2.7557319e-6f + a2 * -2.5052108e-8f)))));
    u += loaded(w.ax + i) * cosine;
    v += loaded(w.ay + i) * cosine;
    s += loaded(w.az + i) * cosine;
  }
  const Float8* const parts[3] = {&u, &v, &s};
  for (int k = 0; k < 3; ++k) {
    const Float8& a = *parts[k];
    out[k] = ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]));
  }
}

using Sum = void (*)(const AmbientWind::Waves&, const float (&)[3], float (&)[3]);
void sum_plain(const AmbientWind::Waves& w, const float (&x)[3], float (&out)[3]) {
  sum_waves(w, x, out);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) void sum_avx2(const AmbientWind::Waves& w, const float (&x)[3],
                                              float (&out)[3]) {
  sum_waves(w, x, out);
}
const Sum kSum = __builtin_cpu_supports("avx2") ? sum_avx2 : sum_plain;
#else
const Sum kSum = sum_plain;
#endif

}  // namespace

AmbientWind::AmbientWind(const AmbientParameters& p) : parameters_(p) {
  const double speed = p.mean.norm();
  const bool sound = p.mean.allFinite() && speed > 0 && speed < 200 && p.intensity >= 0 && p.intensity <= 2 &&
                     p.across >= 0 && p.up >= 0 && std::isfinite(p.across + p.up) && p.length_scale > 0 &&
                     std::isfinite(p.length_scale) && p.coherence_decay >= 0 && p.coherence_decay <= 1000 &&
                     p.frequencies > 0 && p.waves > 0 && size_t(p.frequencies) * p.waves <= kMostWaves;
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
  const double step = std::pow(kHighest / kLowest, 1.0 / p.frequencies);
  for (unsigned i = 0; i < p.frequencies; ++i) {
    const double n0 = kLowest * std::pow(step, i), n1 = n0 * step;
    // A cosine has half its squared amplitude as variance.
    const double a = sigma * std::sqrt(2 * variance_between(von_karman_along, n0, n1) / p.waves);
    const double b = sigma * std::sqrt(2 * variance_between(von_karman_across, n0 / 2, n1 / 2) / p.waves);
    for (unsigned wave = 0; wave < p.waves; ++wave) {
      const double frequency = n0 * std::pow(step, random.uniform()) * per_length;
      const double scale = p.coherence_decay * frequency / (2 * kPi * speed);
      const double y = random.normal(), z = random.normal(), over = std::abs(random.normal());
      Vec3 across = scale / std::max(over, 1e-9) * (y * side + z * up);
      if (across.norm() > kFinest) across *= kFinest / across.norm();
      const double v_sign = random.uniform() < 0.5 ? -1 : 1, w_sign = random.uniform() < 0.5 ? -1 : 1;
      add_wave(frequency / speed * along + across, frequency, random.uniform(),
               a * along + b * (v_sign * p.across * side + w_sign * p.up * up));
    }
  }
  while (kx_.size() % 8 != 0) add_wave(Vec3::Zero(), 0, 0, Vec3::Zero());
}

void AmbientWind::add_wave(const Vec3& turns, double frequency, double phase, const Vec3& amplitude) {
  kx_.push_back(static_cast<float>(turns.x()));
  ky_.push_back(static_cast<float>(turns.y()));
  kz_.push_back(static_cast<float>(turns.z()));
  ax_.push_back(static_cast<float>(amplitude.x()));
  ay_.push_back(static_cast<float>(amplitude.y()));
  az_.push_back(static_cast<float>(amplitude.z()));
  frequency_.push_back(frequency);
  phase_.push_back(phase);
}

Vec3 AmbientWind::velocity(const Vec3& position, double time) const {
  Vec3 out;
  velocities({&position, 1}, time, {&out, 1});
  return out;
}

void AmbientWind::velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
  std::array<float, kMostWaves> phase;
  const size_t count = kx_.size();
  for (size_t i = 0; i < count; ++i) {
    const double turns = phase_[i] - frequency_[i] * time;
    phase[i] = static_cast<float>(turns - std::floor(turns));
  }
  const Waves waves{kx_.data(), ky_.data(), kz_.data(), phase.data(),
                    ax_.data(), ay_.data(), az_.data(), count};
  for (size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f place = positions[i].cast<float>();
    const float x[3] = {place.x(), place.y(), place.z()};
    float u[3];
    kSum(waves, x, u);
    out[i] = parameters_.mean + Vec3(u[0], u[1], u[2]);
  }
}

}  // namespace liana
