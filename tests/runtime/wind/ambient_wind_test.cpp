#include "runtime/wind/field/ambient_wind.h"

#include <gtest/gtest.h>

#include <complex>

#include "mesher/base/error.h"

namespace liana {
namespace {

using Series = std::vector<double>;

/// What a wind along x does at a place, one sample in `dt` seconds, its part along `axis` less the mean.
Series record(const AmbientWind& wind, const Vec3& place, const Vec3& axis, double dt, size_t n) {
  Series series(n);
  for (size_t i = 0; i < n; ++i) series[i] = (wind.velocity(place, dt * double(i)) - Vec3(5, 0, 0)).dot(axis);
  return series;
}

/// Fourier sum at k periods in the whole record.
std::complex<double> line(const Series& series, size_t k) {
  std::complex<double> sum = 0, turn = 1;
  const std::complex<double> step = std::polar(1.0, -2 * kPi * double(k) / double(series.size()));
  for (const double x : series) sum += x * turn, turn *= step;
  return sum / double(series.size());
}

AmbientParameters gale(uint64_t seed) {
  AmbientParameters parameters;
  parameters.mean = {5, 0, 0};
  parameters.length_scale = 20;
  parameters.seed = seed;
  return parameters;
}

TEST(AmbientWind, HasVonKarmansSpectrum) {
  // The variance in each octave against the integral of the formula. Waves nearer to each other than a record
  // of 410 s can tell beat: in one record an octave may be off by half, in the mean over 40 by a tenth.
  const double dt = 0.1, U = 5, L = 20;
  const size_t n = 4096, seeds = 40;
  const AmbientParameters p = gale(1);
  const double sigma = p.intensity * U;
  struct Part {
    Vec3 axis;
    double (*spectrum)(double);
    double length, sigma;
  };
  for (const Part& part : {Part{Vec3::UnitX(), von_karman_along, L, sigma},
                           Part{Vec3::UnitZ(), von_karman_across, L / 2, p.across * sigma},
                           Part{Vec3::UnitY(), von_karman_across, L / 2, p.up * sigma}}) {
    double found[6] = {}, wanted[6] = {};
    for (size_t seed = 1; seed <= seeds; ++seed) {
      const Series series = record(AmbientWind(gale(seed)), {1, 2, 3}, part.axis, dt, n);
      for (int octave = 0; octave < 6; ++octave)
        for (size_t k = 8 << octave; k < size_t(16) << octave; ++k) {
          found[octave] += 2 * std::norm(line(series, k)) / seeds;
          const double f = double(k) / (dt * n);
          wanted[octave] += part.sigma * part.sigma * part.spectrum(f * part.length / U) / double(k) / seeds;
        }
    }
    for (int octave = 0; octave < 6; ++octave)
      EXPECT_NEAR(found[octave] / wanted[octave], 1, 0.2)
          << (8 << octave) / (dt * n) << " Hz, axis " << part.axis.transpose();
  }
}

TEST(AmbientWind, HasItsMeanAndIntensity) {
  const AmbientWind wind(gale(2));
  const Series series = record(wind, {0, 1, 0}, Vec3::UnitX(), 0.5, 8000);
  double mean = 0, squares = 0;
  for (const double x : series) mean += x / 8000, squares += x * x / 8000;
  EXPECT_NEAR(mean, 0, 0.05);
  // 98 % of the variance lies between the slowest and the fastest wave; what is left of cross terms is 3 %.
  EXPECT_NEAR(std::sqrt(squares), 0.25 * 5, 0.04 * 0.25 * 5);
}

TEST(AmbientWind, HasDavenportsCoherence) {
  // Co-spectrum of two points across the wind over the spectrum, averaged over seeds and an octave: exp(−C f
  // Δ/U). 60 seeds × 13 waves of random direction: standard error below 0.05.
  const double dt = 0.1;
  const size_t n = 1024;
  for (const Vec3& apart : {Vec3(0, 0.5, 0), Vec3(0, 0, 1.5)})
    for (const size_t low : {8, 32}) {
      double co = 0, own = 0, wanted = 0, weight = 0;
      for (uint64_t seed = 1; seed <= 60; ++seed) {
        const AmbientWind wind(gale(seed));
        const Series a = record(wind, Vec3::Zero(), Vec3::UnitX(), dt, n),
                     b = record(wind, apart, Vec3::UnitX(), dt, n);
        for (size_t k = low; k < 2 * low; ++k) {
          const std::complex<double> x = line(a, k), y = line(b, k);
          const double power = (std::norm(x) + std::norm(y)) / 2;
          co += (x * std::conj(y)).real(), own += power;
          wanted += power * std::exp(-10 * double(k) / (dt * n) * apart.norm() / 5), weight += power;
        }
      }
      EXPECT_NEAR(co / own, wanted / weight, 0.07) << low / (dt * n) << " Hz, " << apart.norm() << " m";
    }
}

TEST(AmbientWind, IsCarriedAlongAndTheSameInAnyBatch) {
  const AmbientWind wind(gale(1)), again(gale(1)), other(gale(2));
  std::vector<Vec3> places, out(20);
  for (int i = 0; i < 20; ++i) places.emplace_back(0.3 * i, 1, -0.2 * i);
  wind.velocities(places, 7.5, out);
  double change = 0;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(out[i], again.velocity(places[i], 7.5));
    // Phases are floats of at most some hundred turns: 1e-4 of the waves' 2 m/s.
    EXPECT_LT((out[i] - wind.velocity(places[i] + Vec3(10, 0, 0), 9.5)).norm(), 1e-3);
    change = std::max(change, (out[i] - other.velocity(places[i], 7.5)).norm());
  }
  EXPECT_GT(change, 0.1);
}

TEST(AmbientWind, RefusesNonsense) {
  AmbientParameters parameters;
  parameters.mean = Vec3::Zero();
  EXPECT_THROW(AmbientWind{parameters}, Error);
  parameters = {};
  parameters.length_scale = std::nan("");
  EXPECT_THROW(AmbientWind{parameters}, Error);
}

}  // namespace
}  // namespace liana
