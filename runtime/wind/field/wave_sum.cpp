#include "runtime/wind/field/wave_sum.h"

#include <array>
#include <cmath>

#include "mesher/base/error.h"
#include "runtime/wind/field/simd8.h"

namespace liana {
namespace {

/// One number per wave and array, `count` of them, a multiple of 8.
struct Waves {
  const float *kx, *ky, *kz, *phase;  // turns/m; turns
  const float *ax, *ay, *az;          // m/s
  size_t count;
};

__attribute__((always_inline)) inline Float8 loaded(const float* p) {
  return *reinterpret_cast<const Float8Loose*>(p);
}

/// Σ a cos(2π (κ·x + phase)), eight waves at a time: sine's series to x¹¹ on a quarter turn, good to 6e-8.
__attribute__((always_inline)) inline void sum_waves(const Waves& w, const float (&x)[3], float (&out)[3]) {
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

using Sum = void (*)(const Waves&, const float (&)[3], float (&)[3]);
void sum_plain(const Waves& w, const float (&x)[3], float (&out)[3]) {
  sum_waves(w, x, out);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) void sum_avx2(const Waves& w, const float (&x)[3], float (&out)[3]) {
  sum_waves(w, x, out);
}
const Sum kSum = __builtin_cpu_supports("avx2") ? sum_avx2 : sum_plain;
#else
const Sum kSum = sum_plain;
#endif

}  // namespace

void WaveSum::add(const Vec3& turns, double frequency, double phase, const Vec3& amplitude) {
  require(count_ < kMost, "a sum of at most kMost waves");
  if (count_ == kx_.size()) {
    for (std::vector<float>* numbers : {&kx_, &ky_, &kz_, &ax_, &ay_, &az_}) numbers->resize(count_ + 8, 0);
    frequency_.resize(count_ + 8, 0), phase_.resize(count_ + 8, 0);
  }
  const Eigen::Vector3f k = turns.cast<float>(), a = amplitude.cast<float>();
  kx_[count_] = k.x(), ky_[count_] = k.y(), kz_[count_] = k.z();
  ax_[count_] = a.x(), ay_[count_] = a.y(), az_[count_] = a.z();
  frequency_[count_] = frequency, phase_[count_] = phase;
  ++count_;
}

void WaveSum::add_to(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
  std::array<float, kMost> phase;
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
    out[i] += Vec3(u[0], u[1], u[2]);
  }
}

}  // namespace liana
