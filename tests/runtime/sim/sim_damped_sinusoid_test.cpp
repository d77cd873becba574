#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mesher/base/types.h"
#include "runtime/sim/check/damped_sinusoid.h"

namespace liana {
namespace {

std::vector<double> decay(double frequency, double xi, double dt, size_t samples) {
  const double omega = 2 * kPi * frequency, turn = omega * std::sqrt(1 - xi * xi);
  std::vector<double> record;
  for (size_t i = 0; i < samples; ++i) {
    const double t = dt * static_cast<double>(i);
    record.push_back(std::exp(-xi * omega * t) * std::cos(turn * t - 0.4));
  }
  return record;
}

TEST(DampedSinusoid, RecoversFrequencyAndDampingOverTheWholeRange) {
  for (double frequency : {0.1, 0.7, 3.0, 12.0})
    for (double xi : {0.0, 0.0065, 0.1, 0.6}) {
      const DampedSinusoid fit = fit_damped_sinusoid(decay(frequency, xi, 0.025, 3200), 0.025);
      ASSERT_TRUE(fit.found);
      EXPECT_NEAR(fit.frequency, frequency, 1e-5 * frequency) << "nu " << frequency << " xi " << xi;
      EXPECT_NEAR(fit.damping_factor, xi, 1e-5) << "nu " << frequency << " xi " << xi;
    }
}

TEST(DampedSinusoid, LeavesOutWeakerSwingsAndDecays) {
  std::vector<double> record = decay(1.1, 0.03, 0.025, 400), higher = decay(6.3, 0.08, 0.025, 400);
  for (size_t i = 0; i < record.size(); ++i)
    record[i] += 0.3 * higher[i] + 0.2 * std::pow(0.6, static_cast<double>(i));
  const DampedSinusoid fit = fit_damped_sinusoid(record, 0.025);
  EXPECT_NEAR(fit.frequency, 1.1, 1e-4);
  EXPECT_NEAR(fit.damping_factor, 0.03, 1e-4);
}

TEST(DampedSinusoid, FindsNothingWhereNothingSwings) {
  std::vector<double> record;
  for (int i = 0; i < 100; ++i) record.push_back(std::exp(-0.1 * i));
  EXPECT_FALSE(fit_damped_sinusoid(record, 0.025).found);
  EXPECT_FALSE(fit_damped_sinusoid(std::vector<double>(100, 0.0), 0.025).found);
  EXPECT_FALSE(fit_damped_sinusoid(std::vector<double>{1, 2}, 0.025).found);
}

}  // namespace
}  // namespace liana
