#include <gtest/gtest.h>

#include "runtime/sim/check/verify.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

Progress silent;

TEST(Verify, EveryDomainOfATreeSwingsAsBakedAtThePapersStep) {
  const VerifyReport report = verify_bake(test::synthetic_bake(), {}, 2, silent);
  EXPECT_TRUE(report.within);
  EXPECT_LT(report.max_frequency_error, 1e-3);
  EXPECT_LT(report.max_damping_error, 0.01);
  for (const DomainVerdict& v : report.domains) EXPECT_LT(v.residual, 1e-3) << v.id.value;
}

TEST(Verify, FollowsTheBakeAndNotTheShape) {
  // The same rod for every target: from 0.1 to 12 Hz, four orders of magnitude in stiffness.
  for (double frequency : {0.1, 0.3, 1.0, 2.0, 5.0, 12.0})
    for (double xi : {0.0065, 0.05, 0.3, 0.6}) {
      const Bake bake = test::rod_bake({.frequency = frequency, .damping_factor = xi});
      const DomainVerdict v = verify_bake(bake, {}, 1, silent).domains[0];
      EXPECT_LT(v.frequency_error, 1e-3) << "nu " << frequency << " xi " << xi;
      EXPECT_LT(v.damping_error, 0.01) << "nu " << frequency << " xi " << xi;
    }
}

TEST(Verify, NoticesAPlantThatIsCalibratedForAnotherStep) {
  // A chain calibrated for 25 ms but stepped at 5 ms is off; the measurement must say so.
  Plant plant = test::rod_plant({.frequency = 3}, 10);
  calibrate_plant(plant);
  plant.scheme.dt = 0.005;
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  chain.lowest_eigenvalue();
  const DampedSinusoid swing = probe(chain).swing;
  EXPECT_GT(std::abs(swing.frequency / 3 - 1), 0.01);
}

TEST(Verify, SameVerdictsOnOneThreadAndOnTwo) {
  const Bake bake = test::synthetic_bake({.branches = 3});
  const VerifyReport one = verify_bake(bake, {}, 1, silent), two = verify_bake(bake, {}, 2, silent);
  for (size_t i = 0; i < one.domains.size(); ++i) {
    EXPECT_EQ(one.domains[i].frequency_measured, two.domains[i].frequency_measured);
    EXPECT_EQ(one.domains[i].damping_measured, two.domains[i].damping_measured);
  }
}

TEST(Verify, BakeWithoutDomainsIsAnError) {
  EXPECT_THROW(verify_bake(Bake{}, {}, 1, silent), Error);
}

}  // namespace
}  // namespace liana
