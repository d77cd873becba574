#include <gtest/gtest.h>

#include <limits>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

const StepOptions kWeightless{.gravity = Vec3::Zero()};

Plant calibrated_rod(double frequency, double damping_factor, int particles) {
  Plant plant = test::rod_plant({.frequency = frequency, .damping_factor = damping_factor}, particles);
  calibrate_plant(plant);
  return plant;
}

// A rod that nothing holds.
Plant free_rod(int particles) {
  Plant plant = calibrated_rod(2, 0.05, particles);
  plant.particles[0].joint.shear_stiffness = plant.particles[0].joint.bend_stiffness = Vec3::Zero();
  for (Particle& p : plant.particles) p.mass_damping = 0;
  return plant;
}

Vec3 momentum(const Plant& plant) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < plant.particles.size(); ++i)
    sum += plant.particles[i].mass * plant.motion[i].velocity;
  return sum;
}

Vec3 angular_momentum(const Plant& plant) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum += p.mass * m.position.cross(m.velocity) + m.orientation * p.inertia.cwiseProduct(spin).eval();
  }
  return sum;
}

double energy(const Plant& plant) {
  double sum = 0;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const auto pose = [&](size_t k) {
      return BodyPose{.position = plant.motion[k].position, .orientation = plant.motion[k].orientation};
    };
    const JointStrain e =
        joint_strain(p.joint, p.parent.valid() ? pose(p.parent.index()) : BodyPose(), pose(i));
    const Vec3 spin = m.orientation.conjugate() * m.angular_velocity;
    sum += 0.5 * (p.mass * m.velocity.squaredNorm() + p.inertia.dot(spin.cwiseAbs2()) +
                  p.joint.shear_stiffness.dot(e.shear.cwiseAbs2()) +
                  p.joint.bend_stiffness.dot(e.bend.vector.cwiseAbs2()));
  }
  return sum;
}

// Sideways, the tip at `speed`, the rest by the square of its height.
void kick(Plant& plant, double speed) {
  const double top = plant.motion.back().position.y();
  for (Motion& m : plant.motion) m.velocity = speed * std::pow(m.position.y() / top, 2) * Vec3(0.6, 0, 0.8);
}

double fastest(const Plant& plant) {
  double speed = 0;
  for (const Motion& m : plant.motion) speed = std::max(speed, m.velocity.norm());
  return speed;
}

TEST(TimeStep, FreeRodFallsWithGravityAndKeepsItsSidewaysMomentum) {
  Plant plant = free_rod(8);
  for (Motion& m : plant.motion) {
    m.velocity = Vec3(1, 0, -2);
    m.acceleration = Vec3(0, -9.81, 0);
  }
  plant.motion.back().velocity += Vec3(0.3, 0, 0);
  const Vec3 before = momentum(plant);
  double mass = 0;
  for (const Particle& p : plant.particles) mass += p.mass;
  PlantStepper stepper;
  for (int i = 0; i < 40; ++i) stepper.step(plant, {}, {}, {});
  // The total acceleration is g in every step, so generalized-α adds g dt exactly; only rounding is left.
  EXPECT_NEAR((momentum(plant) - before - mass * Vec3(0, -9.81, 0)).norm(), 0, 1e-9 * mass);
}

TEST(TimeStep, FreeRodKeepsItsMomentaWhileItTumblesAndSwings) {
  Plant plant = free_rod(8);
  for (Motion& m : plant.motion) {  // tumbling about its middle, one turn in 4 s
    const Vec3 arm = m.position - Vec3(0, 0.5, 0);
    m.angular_velocity = Vec3(0, 0, 1.5);
    m.velocity = m.angular_velocity.cross(arm);
    m.acceleration = m.angular_velocity.cross(m.velocity);
  }
  const Vec3 linear = momentum(plant), angular = angular_momentum(plant);
  PlantStepper stepper;
  for (int i = 0; i < 80; ++i) stepper.step(plant, {}, {}, kWeightless);
  EXPECT_NEAR((momentum(plant) - linear).norm(), 0, 1e-9 * angular.norm());
  // Joints exert no net moment; what drifts is the step's own, (ω dt)² ≈ 1.4e-3 a step at most and mostly
  // cancelling.
  EXPECT_NEAR((angular_momentum(plant) - angular).norm(), 0, 0.02 * angular.norm());
}

TEST(TimeStep, EnergyOfAReleasedBranchOnlyDecays) {
  for (double dt : {0.025, 0.005}) {
    Plant plant = test::rod_plant({.frequency = 1, .damping_factor = 0.0065}, 12);
    calibrate_plant(plant, {.dt = dt});
    kick(plant, 0.5);
    const double start = energy(plant);
    PlantStepper stepper;
    StepOptions options = kWeightless;
    options.dt = dt;
    double peak = 0, last_second = 0;
    for (double t = 0; t < 20; t += dt) {
      stepper.step(plant, {}, {}, options);
      peak = std::max(peak, energy(plant));
      if (t >= 19) last_second = std::max(last_second, energy(plant));
    }
    // The step has an energy of its own, which within a swing differs from this one by a share (ωh)²/4 of a
    // mode's: a quarter for the second mode at 25 ms, but that mode holds little of the energy.
    EXPECT_LE(peak, 1.05 * start);
    EXPECT_LT(last_second, 0.3 * start);
  }
}

struct Ride {
  double top_speed = 0, gap = 0;
  int solves = 0;
};

Ride ride(Plant& plant, int steps) {
  PlantStepper stepper;
  Ride r;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = stepper.step(plant, {}, {}, {});
    EXPECT_TRUE(report.finite);
    r.top_speed = std::max(r.top_speed, fastest(plant));
    r.gap = std::max(r.gap, report.gap);
    r.solves += report.solves;
  }
  return r;
}

TEST(TimeStep, StaysBoundedUnderAnyKickAndComesToRest) {
  for (double speed : {20.0, 100.0}) {
    Plant plant = calibrated_rod(1, 0.05, 20);
    kick(plant, speed);
    const Ride r = ride(plant, 2000);
    EXPECT_LT(r.top_speed, 1.2 * speed);
    EXPECT_LT(r.gap, 0.2) << "of a particle's length";
    EXPECT_LT(r.solves, 1.5 * 2000) << "redone steps are rare";
    EXPECT_LT(fastest(plant), 0.2);
  }
}

TEST(TimeStep, StaysBoundedWhenOneParticleAloneIsShotAway) {
  Plant plant = calibrated_rod(1, 0.05, 20);
  plant.motion.back().velocity = Vec3(60, 20, 77);  // two particle lengths in each of the finest substeps
  const Ride r = ride(plant, 2000);
  EXPECT_LT(r.top_speed, 100);
  EXPECT_LT(r.gap, 1);
  EXPECT_LT(fastest(plant), 0.2);
}

TEST(TimeStep, CountsWhatItRedid) {
  Plant plant = calibrated_rod(1, 0.05, 20);
  PlantStepper stepper;
  EXPECT_EQ(stepper.step(plant, {}, {}, kWeightless).redone, 0);
  kick(plant, 50);
  const StepReport report = stepper.step(plant, {}, {}, kWeightless);
  EXPECT_GT(report.redone, 0);
  EXPECT_GT(report.solves, 2);
}

TEST(TimeStep, NotANumberFromOutsideFreezesThePlantInsteadOfSpreading) {
  Plant plant = calibrated_rod(1, 0.05, 5);
  kick(plant, 1);
  const Vec3 before = plant.motion[3].position;
  std::vector<Wrench> wind(5);
  wind[2].force.x() = std::numeric_limits<double>::quiet_NaN();
  PlantStepper stepper;
  const StepReport report = stepper.step(plant, wind, {}, {});
  EXPECT_FALSE(report.finite);
  EXPECT_EQ(plant.motion[3].position, before);
  EXPECT_EQ(fastest(plant), 0);
  EXPECT_TRUE(stepper.step(plant, {}, {}, {}).finite) << "and it goes on";
}

TEST(TimeStep, AnchorCarriesAPointToItsTargetAndHoldsIt) {
  Plant plant = calibrated_rod(1, 0.2, 10);
  const Vec3 target(
      0.2, 0.9, 0.1);  // a rod held at both ends, buckled: some 12 N at the anchor, 12 µm of a 1e6 N/m spring
  plant.anchors.push_back({.particle = ParticleId(9),
                           .on_particle = {0, 0.05, 0},
                           .target = target,
                           .stiffness = 1e6 * Mat3::Identity(),
                           .damping = 10 * Mat3::Identity()});
  PlantStepper stepper;
  for (int i = 0; i < 600; ++i) ASSERT_TRUE(stepper.step(plant, {}, {}, kWeightless).finite);
  const Motion& tip = plant.motion.back();
  EXPECT_LT((tip.position + tip.orientation * Vec3(0, 0.05, 0) - target).norm(), 1e-4);
  EXPECT_LT(fastest(plant), 1e-4);
}

TEST(TimeStep, TransientSpringIsTheSameAsAnAnchor) {
  Plant anchored = calibrated_rod(1, 0.05, 6), grabbed = anchored;
  const WorldSpring spring{
      .particle = ParticleId(4), .target = {0.3, 0.5, 0}, .stiffness = 50 * Mat3::Identity()};
  anchored.anchors.push_back(spring);
  PlantStepper a, b;
  for (int i = 0; i < 50; ++i) {
    a.step(anchored, {}, {}, {});
    b.step(grabbed, {}, std::span(&spring, 1), {});
  }
  EXPECT_EQ(state_hash(anchored), state_hash(grabbed));
}

TEST(TimeStep, SteadyForceBendsTheRodByItsStaticDeflection) {
  Plant plant = calibrated_rod(1, 0.2, 20);
  const double F = 1e-4;
  std::vector<Wrench> external(20);
  external.back().force = Vec3(F, 0, 0);
  PlantStepper stepper;
  for (int i = 0; i < 1200; ++i) stepper.step(plant, external, {}, kWeightless);
  // Unit-load method on the chain itself: Σ M²/(C F) over the joints, from the tip particle's centre.
  double deflection = 0;
  const double tip = plant.motion.back().position.y();
  for (size_t i = 0; i < 20; ++i) {
    const Joint& joint = plant.particles[i].joint;
    const double arm = tip - 0.05 * static_cast<double>(i);
    deflection += F * arm * arm / joint.bend_stiffness.z() + F / joint.shear_stiffness.x();
  }
  EXPECT_NEAR(plant.motion.back().position.x(), deflection, 1e-3 * deflection);
}

TEST(TimeStep, RunsAreRepeatable) {
  uint64_t first = 0;
  for (int run = 0; run < 2; ++run) {
    Plant plant = make_plant(test::synthetic_bake({.branches = 3}));
    std::vector<Wrench> wind(plant.particles.size(), {.force = {1e-3, 0, 5e-4}});
    PlantStepper stepper;
    for (int i = 0; i < 100; ++i) stepper.step(plant, wind, {}, {});
    if (run == 0) first = state_hash(plant);
    EXPECT_EQ(state_hash(plant), first);
  }
}

TEST(TimeStep, ParticlesAppendedBetweenStepsJoinIn) {
  Plant plant = calibrated_rod(1, 0.05, 6);
  PlantStepper stepper;
  stepper.step(plant, {}, {}, {});
  Particle next = plant.particles.back();
  next.parent = ParticleId(5);
  Motion motion = plant.motion.back();
  motion.position += motion.orientation * Vec3(0, 2 * next.half_length, 0);
  plant.particles.push_back(next);
  plant.motion.push_back(motion);
  plant.branches[0].particles.push_back(ParticleId(6));
  HeldChain chain;
  EXPECT_TRUE(recalibrate(plant, BranchId(0), carried_masses(plant), chain));
  for (int i = 0; i < 40; ++i) {
    const StepReport report = stepper.step(plant, {}, {}, {});
    EXPECT_TRUE(report.finite);
    EXPECT_EQ(report.redone, 0);
  }
}

}  // namespace
}  // namespace liana
