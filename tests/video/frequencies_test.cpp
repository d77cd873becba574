// Frequencies and damping of single records, and whether their stated uncertainty is true.
#include <gtest/gtest.h>

#include "materials/video/modes/decay_fit.h"
#include "materials/video/modes/gust_fit.h"
#include "materials/video/modes/point_modes.h"
#include "mesher/base/error.h"
#include "tests/support/synthetic_tracks.h"

namespace liana {
namespace {

using test::Swing;
using test::TrackShape;

PointModes modes_of(const std::vector<Vec2>& path, double fps, const MotionOptions& options = {}) {
  const PointTracks tracks = test::tracks_of({{"P", path}}, fps);
  return point_modes(tracks, tracks.points.front(), options);
}

TEST(Spectrum, PeakOfASinusoidLiesBetweenBins) {
  std::vector<double> signal;
  for (int n = 0; n < 200; ++n) signal.push_back(std::cos(2 * kPi * 1.237 * n / 30.0));
  const auto peaks = spectrum_peaks(power_spectrum(signal, 1 / 30.0, Window::Hann), 0.3, 12, 10);
  ASSERT_FALSE(peaks.empty());  // the window's side lobes follow, a thousandth as high
  // Resolution is 0.15 Hz; the parabola through the eightfold padded spectrum of a Hann window is off by less
  // than a hundredth of it.
  EXPECT_NEAR(peaks[0].frequency, 1.237, 0.0015);
}

TEST(Spectrum, WhiteNoiseHasItsVarianceInEveryBin) {
  Random random(5, "noise");
  std::vector<double> signal;
  for (int n = 0; n < 4096; ++n) signal.push_back(2 * random.normal());
  // The mean over 1800 bins varies by 1.94/√1800 of 4: four deviations.
  EXPECT_NEAR(power_spectrum(signal, 0.1, Window::Hann, 1).local_mean(0.3, 4.7), 4,
              4 * 4 * 1.4 / std::sqrt(1800));
}

TEST(Decay, NoiselessSwingsAreRecovered) {
  Random random(1, "decay");
  const PointModes found =
      modes_of(test::decaying_path({.noise = 1e-6, .swings = {{1.1, 0.04, 20}, {2.7, 0.07, 6}}}, random), 30);
  ASSERT_GE(found.modes.size(), 2u);
  EXPECT_EQ(found.excitation, Excitation::FreeDecay);
  EXPECT_NEAR(found.modes[0].frequency, 1.1, 1e-5);
  EXPECT_NEAR(found.modes[0].damping_factor, 0.04, 1e-5);
  EXPECT_NEAR(found.modes[1].frequency, 2.7, 1e-4);
  EXPECT_NEAR(found.modes[1].damping_factor, 0.07, 1e-4);
  EXPECT_NEAR(found.direction.x(), std::cos(0.5), 1e-6);
}

TEST(Decay, StatedUncertaintyCoversTheTruthInNineOfTenRecords) {
  int trials = 0, frequency_covered = 0, damping_covered = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed, "coverage");
    const double nu = random.uniform(0.6, 4), xi = random.uniform(0.01, 0.12);
    const auto path =
        test::decaying_path({.fps = 25, .seconds = 10, .noise = 0.3, .swings = {{nu, xi, 10}}}, random);
    const PointModes found = modes_of(path, 25);
    ASSERT_FALSE(found.modes.empty());
    const MeasuredMode& m = found.modes.front();
    ++trials;
    frequency_covered += std::abs(m.frequency - nu) < kCoverage95 * m.frequency_sigma;
    damping_covered += std::abs(m.damping_factor - xi) < kCoverage95 * m.damping_sigma;
    EXPECT_LT(m.frequency_sigma, 0.02 * nu);  // and it is no empty statement
  }
  EXPECT_GE(frequency_covered, 0.9 * trials);
  EXPECT_GE(damping_covered, 0.9 * trials);
}

TEST(Gusts, StatedUncertaintyCoversTheTruthInNineOfTenRecords) {
  int trials = 0, frequency_covered = 0, damping_covered = 0;
  double worst = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, "gusts");
    const double nu = random.uniform(0.8, 3), xi = random.uniform(0.03, 0.1), fps = 25;
    const size_t count = 1500;  // a minute
    const auto swing = test::pushed_oscillator(nu, xi, 1 / fps, count, random),
               wind = test::slow_gusts(1.5, 1 / fps, count, random);
    std::vector<Vec2> path;
    for (size_t n = 0; n < count; ++n)
      path.push_back({5 * swing[n] + 5 * wind[n] + 0.1 * random.normal(), 0.1 * random.normal()});
    const PointModes found = modes_of(path, fps, {.low = 0.4});
    EXPECT_EQ(found.excitation, Excitation::Wind);
    const auto nearest =
        std::min_element(found.modes.begin(), found.modes.end(), [&](const auto& a, const auto& b) {
          return std::abs(a.frequency - nu) < std::abs(b.frequency - nu);
        });
    ASSERT_NE(nearest, found.modes.end());
    ++trials;
    frequency_covered += std::abs(nearest->frequency - nu) < kCoverage95 * nearest->frequency_sigma;
    damping_covered += std::abs(nearest->damping_factor - xi) < kCoverage95 * nearest->damping_sigma;
    worst = std::max(worst, std::abs(nearest->frequency / nu - 1));
  }
  EXPECT_GE(frequency_covered, 0.9 * trials);
  EXPECT_GE(damping_covered, 0.9 * trials);
  // Theory: σ_ν/ν = √(ξ / 2πνT) at best, 1.8 % at ξ = 0.1 and 0.8 Hz; four of them.
  EXPECT_LT(worst, 0.08);
}

TEST(Gusts, NoiseAloneIsNotDamping) {
  Random random(3, "still");
  std::vector<Vec2> path;
  for (int n = 0; n < 400; ++n) path.push_back(0.005 * Vec2(random.normal(), random.normal()));
  EXPECT_THROW(modes_of(path, 25), Error);
}

}  // namespace
}  // namespace liana
