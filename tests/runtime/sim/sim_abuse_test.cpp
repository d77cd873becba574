// Whatever is done to a plant: it stays finite, its speed bounded, and once it is left alone it has no more
// energy than it was left with.
#include <gtest/gtest.h>

#include "mesher/base/random.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/check/damped_sinusoid.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/joints.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/plant_energy.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

double fastest(const Plant& plant) {
  double speed = 0;
  for (const Motion& m : plant.motion) speed = std::max(speed, m.velocity.norm());
  return speed;
}

struct Tormented {
  Plant plant = make_plant(test::synthetic_bake({.branches = 3}));
  PlantStepper stepper;
  std::vector<WorldSpring> springs;
  std::vector<Wrench> wind;
  double top_speed = 0;
  int redone = 0;

  void step(double dt = 0.025) {
    const StepReport report = stepper.step(plant, wind, springs, {.dt = dt});
    ASSERT_TRUE(report.finite);
    redone += report.redone;
    top_speed = std::max(top_speed, fastest(plant));
  }
  // Left alone: the energy at rest, where it stands as modelled, is its lowest for a stable tree.
  void expect_calm_after(double seconds) {
    springs.clear();
    wind.clear();
    const double rest = visible_energy(make_plant(test::synthetic_bake({.branches = 3})));
    step();
    const double left_with = visible_energy(plant) - rest;
    double most = 0;
    for (double t = 0; t < seconds; t += 0.025) {
      step();
      most = std::max(most, visible_energy(plant) - rest);
    }
    // Within a swing the step's own energy differs from this one by (ωh)²/4 of a mode's.
    EXPECT_LT(most, 1.1 * left_with + 1e-3);
    EXPECT_LT(visible_energy(plant) - rest, 0.1 * left_with + 1e-3);
  }
};

TEST(Abuse, ImpulsesOfAHundredMetresPerSecond) {
  Tormented t;
  Random random(7, "abuse/impulses");
  for (int i = 0; i < 200; ++i) {
    if (i % 20 == 0) {
      const Vec3 kick =
          100 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
      const size_t first = random.next() % t.plant.motion.size();
      for (size_t k = first; k < std::min(first + 5, t.plant.motion.size()); ++k)
        t.plant.motion[k].velocity += kick;
    }
    t.step();
  }
  EXPECT_LT(t.top_speed, 200);
  EXPECT_GT(t.redone, 0);
  t.expect_calm_after(10);
}

TEST(Abuse, SupportTeleported) {
  Tormented t;
  Joint& root = t.plant.particles[0].joint;
  const Vec3 home = root.on_parent;
  for (int i = 0; i < 60; ++i) {
    if (i % 15 == 5) root.on_parent = home + Vec3(i % 2 ? 3 : -2, 1, i % 4);
    t.step();
  }
  root.on_parent = home;
  for (int i = 0; i < 40; ++i) t.step();
  // The root is carried 4 m within one step of 25 ms: 160 m/s, and the tips are whipped.
  EXPECT_LT(t.top_speed, 800);
  t.expect_calm_after(20);
}

TEST(Abuse, GrabbedAndShaken) {
  Tormented t;
  const size_t tip = t.plant.motion.size() - 1;
  const Vec3 home = t.plant.motion[tip].position;
  for (int i = 0; i < 200; ++i) {
    t.springs = {{.particle = ParticleId(tip),
                  .target = home + Vec3(i % 3 - 1, (i / 2) % 2, i % 5 - 2),
                  .stiffness = 1e4 * Mat3::Identity(),
                  .damping = 10 * Mat3::Identity()}};
    t.step();
  }
  EXPECT_LT(t.top_speed, 500);
  t.expect_calm_after(10);
}

TEST(Abuse, WindOfSixtyMetresPerSecond) {
  Tormented t;
  for (int i = 0; i < 200; ++i) {
    t.springs.clear();
    for (size_t k = 0; k < t.plant.motion.size(); ++k) {
      const Particle& p = t.plant.particles[k];
      const double area = 4 * p.half_length * p.half_width;
      const double relative = (Vec3(60, 0, 0) - t.plant.motion[k].velocity).norm();
      t.springs.push_back({.particle = ParticleId(k),
                           .target = t.plant.motion[k].position,
                           .damping = 0.6 * area * relative * Mat3::Identity(),
                           .target_velocity = Vec3(60, 0, 0)});
    }
    t.step();
  }
  EXPECT_LT(t.top_speed, 120);
  t.expect_calm_after(10);
}

TEST(Abuse, StepsOfOneToAHundredMilliseconds) {
  Tormented t;
  Random random(3, "abuse/steps");
  t.wind.assign(t.plant.motion.size(), {.force = {4e-3, 0, 1e-3}});
  for (int i = 0; i < 400; ++i) t.step(std::pow(10, random.uniform(-3, -1)));
  EXPECT_LT(t.top_speed, 20);
  t.expect_calm_after(10);
}

TEST(Abuse, DroppedFromAHeightOntoASpring) {
  Tormented t;
  t.plant = detach_subtree(t.plant, t.plant.branches[1].particles[1]);
  for (int i = 0; i < 200; ++i) {
    t.springs.clear();
    for (size_t k = 0; k < t.plant.motion.size(); ++k) {
      const Vec3& x = t.plant.motion[k].position;
      if (x.y() > 0) continue;
      t.springs.push_back({.particle = ParticleId(k),
                           .target = {x.x(), 0, x.z()},
                           .stiffness = 1e4 * Mat3::Identity(),
                           .damping = 5 * Mat3::Identity()});
    }
    t.step();
  }
  EXPECT_LT(t.top_speed, 30);
  EXPECT_LT(fastest(t.plant), 3);
}

TEST(Abuse, ParticlesWithoutMassOrLengthAndInTheSamePlace) {
  Tormented t;
  for (size_t i = 1; i < t.plant.particles.size(); i += 3) {
    t.plant.particles[i].mass = 0;
    t.plant.particles[i].inertia.setZero();
  }
  for (size_t i = 5; i < t.plant.particles.size(); i += 7) {
    t.plant.particles[i].half_length = 0;
    t.plant.particles[i].joint.on_self.setZero();
    t.plant.motion[i].position = t.plant.motion[t.plant.particles[i].parent.index()].position;
  }
  for (int i = 0; i < 400; ++i) {
    if (i == 200)
      for (Motion& m : t.plant.motion) m.velocity += Vec3(20, 0, 10);
    t.step();
  }
  EXPECT_LT(t.top_speed, 300);
  // Not even one particle with mass.
  for (Particle& p : t.plant.particles) p.mass = 0, p.inertia.setZero();
  t.wind.assign(t.plant.motion.size(), {.force = {4e-3, 0, 1e-3}});
  for (int i = 0; i < 20; ++i) t.step();
}

// Stretching is 4e4 times stiffer than bending, as in a twig of 100 particles: the digits that are left to
// the bending must carry it through a minute.
TEST(Precision, MinuteOfFreeSwingOfAThinTwigKeepsFrequencyAndDamping) {
  constexpr double kDt = 0.025, kFrequency = 1, kDamping = 0.005;
  Plant plant = test::rod_plant(
      {.length = 1, .radius = 1e-4, .frequency = kFrequency, .damping_factor = kDamping}, 100);
  const Joint& joint = plant.particles[50].joint;
  ASSERT_NEAR(joint.shear_stiffness.y() * std::pow(0.01, 2) / joint.bend_stiffness.x(), 4e4, 1);
  calibrate_plant(plant);
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  chain.lowest_eigenvalue();
  for (size_t i = 0; i < 100; ++i) {  // let go from a bend of a thousandth
    const double scale = 1e-3 / chain.mode()[99].head<3>().norm();
    plant.motion[i].position += scale * chain.mode()[i].head<3>();
    plant.motion[i].orientation =
        rotation_exp(scale * chain.mode()[i].tail<3>()) * plant.motion[i].orientation;
  }
  const Vec3 along = plant.motion[99].position - Vec3(0, 0.995, 0);
  PlantStepper stepper;
  std::vector<double> swing;
  for (int i = 0; i < 60 / kDt; ++i) {
    const StepReport report = stepper.step(plant, {}, {}, {.gravity = Vec3::Zero()});
    ASSERT_EQ(report.redone, 0);
    swing.push_back((plant.motion[99].position - Vec3(0, 0.995, 0)).dot(along.normalized()));
  }
  for (const size_t start : {size_t{100}, swing.size() - 300}) {
    const DampedSinusoid fit = fit_damped_sinusoid(std::span(swing).subspan(start, 280), kDt);
    ASSERT_TRUE(fit.found);
    EXPECT_NEAR(fit.frequency, kFrequency, 1e-4 * kFrequency);
    EXPECT_NEAR(fit.damping_factor, kDamping, 1e-4);
  }
}

}  // namespace
}  // namespace liana
