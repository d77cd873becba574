// Motions with a known answer: a pendulum, a whirling branch, a falling free branch.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

struct Momenta {
  double mass = 0;
  Vec3 centre = Vec3::Zero(), linear = Vec3::Zero(), angular = Vec3::Zero();  ///< angular about the centre
};

Momenta momenta(const Plant& plant) {
  Momenta sum;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const double m = plant.particles[i].mass;
    sum.mass += m;
    sum.centre += m * plant.motion[i].position;
    sum.linear += m * plant.motion[i].velocity;
  }
  sum.centre /= sum.mass;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum.angular += p.mass * (m.position - sum.centre).cross(m.velocity - sum.linear / sum.mass) +
                   m.orientation * p.inertia.cwiseProduct(spin).eval();
  }
  return sum;
}

// A stick of 1 m that hangs from a hinge: T = 4 K(sin(a/2)) / ω₀, ω₀² = m g l / I.
TEST(Pendulum, PeriodAtSmallAndAtLargeAmplitudes) {
  constexpr double kDt = 0.002;
  for (const double amplitude : {0.01, 0.5, 1.5}) {
    Plant plant = test::rod_plant({.radius = 0.01}, 1);
    Joint& hinge = plant.particles[0].joint;
    hinge.bend_stiffness.setZero();
    plant.scheme = {.dt = kDt, .rho_infinity = 1};
    const Quat start(Eigen::AngleAxisd(kPi + amplitude, Vec3::UnitZ()));
    plant.motion[0] = {.position = start * Vec3(0, 0.5, 0), .orientation = start};
    PlantStepper stepper;
    std::vector<double> crossings;
    double before = plant.motion[0].position.x();
    for (int i = 1; crossings.size() < 9; ++i) {
      ASSERT_LT(i, 20000);
      ASSERT_EQ(stepper.step(plant, {}, {}, {.dt = kDt}).redone, 0);
      const double x = plant.motion[0].position.x();
      if (before * x < 0) crossings.push_back((i - x / (x - before)) * kDt);
      before = x;
    }
    const Particle& p = plant.particles[0];
    const double own = std::sqrt(p.mass * 9.81 * 0.5 / (p.inertia.z() + p.mass * 0.25));
    const double period = 4 * std::comp_ellint_1(std::sin(amplitude / 2)) / own;
    const double measured = (crossings[8] - crossings[0]) / 4;
    RecordProperty("period_error_at_" + std::to_string(amplitude), std::to_string(measured / period - 1));
    // The step lengthens a swing by (ωh)²/12, 5e-6 here; the crossings' times are good to 1e-5.
    EXPECT_NEAR(measured, period, 1e-4 * period) << "amplitude " << amplitude;
  }
}

// Both swings of an undamped round rod a quarter of a turn apart: its tip goes round in a circle.
TEST(Whirling, TipOfAHeldBranchStaysOnItsCircle) {
  constexpr double kFrequency = 1, kRadius = 1e-3;
  Plant plant = test::rod_plant({.frequency = kFrequency, .damping_factor = 0}, 20);
  calibrate_plant(plant);
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  chain.lowest_eigenvalue();
  const Quat quarter(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));
  const double scale = kRadius / chain.mode().back().head<3>().norm(), omega = 2 * kPi * kFrequency;
  for (size_t i = 0; i < plant.motion.size(); ++i) {
    Motion& m = plant.motion[i];
    const Vec3 move = scale * chain.mode()[i].head<3>(), turn = scale * chain.mode()[i].tail<3>();
    m.position += move;
    m.orientation = rotation_exp(turn) * m.orientation;
    m.velocity = omega * (quarter * move);
    m.angular_velocity = omega * (quarter * turn);
    m.acceleration = -omega * omega * move;
    m.angular_acceleration = -omega * omega * turn;
  }
  const double about_stem = momenta(plant).angular.y();
  PlantStepper stepper;
  double least = 1, most = 0;
  for (int i = 0; i < 2400; ++i) {  // a minute
    stepper.step(plant, {}, {}, {.gravity = Vec3::Zero()});
    if (i < 40) continue;  // what is not of the lowest mode dies away
    const double r = std::hypot(plant.motion.back().position.x(), plant.motion.back().position.z()) / kRadius;
    least = std::min(least, r);
    most = std::max(most, r);
  }
  RecordProperty("least_radius", std::to_string(least));
  RecordProperty("most_radius", std::to_string(most));
  // The step's own velocities differ from the continuous mode's by (ωh)²/12 = 0.2 %; ξ below 5e-5 takes at
  // most 2π·60·5e-5 = 2 % in a minute.
  EXPECT_GT(least, 0.97);
  EXPECT_LT(most, 1.01);
  EXPECT_NEAR(momenta(plant).angular.y(), about_stem, 0.05 * std::abs(about_stem));
}

// A free limb with twigs and leaves, bent, thrown and tumbling.
Plant thrown_limb(double spin) {
  Plant tree = make_plant(test::synthetic_bake({.branches = 3}));
  for (size_t i = 0; i < tree.motion.size(); ++i)
    tree.motion[i].velocity =
        0.3 * Vec3(std::sin(1.7 * static_cast<double>(i)), std::cos(static_cast<double>(i)), 0.5);
  PlantStepper stepper;
  for (int i = 0; i < 20; ++i) stepper.step(tree, {}, {}, {});
  Plant limb = detach_subtree(tree, tree.branches[1].particles[0]);
  const Vec3 centre = momenta(limb).centre, turning = spin * Vec3(0.3, 0.9, -0.3).normalized();
  for (Motion& m : limb.motion) {
    m.velocity += Vec3(1, 2, -0.5) + turning.cross(m.position - centre);
    m.angular_velocity += turning;
  }
  return limb;
}

TEST(FreeFlight, FallingLimbKeepsItsMomentumAndItsAngularMomentum) {
  for (const double spin : {0.5, 3.0, 9.0}) {  // rad/s
    Plant limb = thrown_limb(spin);
    for (Motion& m : limb.motion) m.acceleration = Vec3(0, -9.81, 0), m.angular_acceleration.setZero();
    const Momenta before = momenta(limb);
    PlantStepper stepper;
    double linear = 0, angular = 0;
    for (int i = 1; i <= 120; ++i) {
      ASSERT_TRUE(stepper.step(limb, {}, {}, {}).finite);
      const Momenta now = momenta(limb);
      const Vec3 fallen = before.linear + before.mass * (i * 0.025) * Vec3(0, -9.81, 0);
      linear = std::max(linear, (now.linear - fallen).norm() / before.linear.norm());
      angular = std::max(angular, (now.angular - before.angular).norm() / before.angular.norm());
    }
    RecordProperty("momentum_at_" + std::to_string(spin), std::to_string(1e9 * linear) + "e-9");
    RecordProperty("angular_momentum_at_" + std::to_string(spin), std::to_string(1e9 * angular) + "e-9");
    EXPECT_LT(linear, 1e-6) << "spin " << spin;
    EXPECT_LT(angular, 1e-6) << "spin " << spin;
  }
}

TEST(FreeFlight, CentreOfMassFallsOnAParabola) {
  Plant limb = thrown_limb(3);
  for (Motion& m : limb.motion) m.acceleration = Vec3(0, -9.81, 0), m.angular_acceleration.setZero();
  const Momenta before = momenta(limb);
  PlantStepper stepper;
  for (int i = 0; i < 80; ++i) stepper.step(limb, {}, {}, {});
  const double t = 2;
  const Vec3 wanted = before.centre + t * before.linear / before.mass + t * t / 2 * Vec3(0, -9.81, 0);
  EXPECT_LT((momenta(limb).centre - wanted).norm(), 1e-6 * (wanted - before.centre).norm());
}

TEST(FreeFlight, WhirlingLimbGainsNoEnergy) {
  Plant limb = thrown_limb(9);
  const auto kinetic = [&] {
    double sum = 0;
    for (size_t i = 0; i < limb.particles.size(); ++i)
      sum += 0.5 * limb.particles[i].mass * limb.motion[i].velocity.squaredNorm();
    return sum;
  };
  const double start = kinetic();
  PlantStepper stepper;
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    stepper.step(limb, {}, {}, {.gravity = Vec3::Zero()});
    most = std::max(most, kinetic());
  }
  // Bent joints may give back what they held: a branch that swung at 0.3 m/s beside a tumble of some 2 m/s.
  EXPECT_LT(most, 1.1 * start);
}

}  // namespace
}  // namespace liana
