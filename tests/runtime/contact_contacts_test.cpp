#include <gtest/gtest.h>

#include "runtime/sim/collision/box_mesh.h"
#include "runtime/sim/collision/contact_step.h"
#include "runtime/sim/rod_section.h"

namespace liana {
namespace {

/// One free stem particle, 6 cm long and 4 mm thick, of 2 g, after a root that the world holds far above and that
/// holds nothing itself.
Plant loose_stick(const Vec3& position, const Quat& orientation) {
  Plant plant;
  plant.branches.resize(1);
  for (int i = 0; i < 2; ++i) {
    Particle particle;
    particle.branch = BranchId(0);
    particle.half_length = 0.03;
    particle.half_width = particle.half_thickness = 2e-3;
    particle.mass = 2e-3;
    particle.inertia = rod_inertia(2e-3, 0.03, 2e-3, 2e-3);
    if (i == 1) particle.parent = ParticleId(0);
    if (i == 0) {
      particle.joint.on_parent = {0, 50, 0};
      particle.joint.shear_stiffness = Vec3::Constant(1e3);
    }
    plant.particles.push_back(particle);
    plant.branches[0].particles.push_back(ParticleId(i));
  }
  plant.motion.resize(2);
  plant.motion[0].position = {0, 50, 0};
  plant.motion[1].position = position;
  plant.motion[1].orientation = orientation;
  return plant;
}

const Quat kLying(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));

struct Course {
  double deepest = 0, last_speed = 0;
};

Course run(Plant& plant, const CollisionScene& scene, int steps, const Vec3& gravity = {0, -9.81, 0}) {
  ContactStepper stepper;
  StepOptions options;
  options.gravity = gravity;
  Course result;
  for (int i = 0; i < steps; ++i) {
    std::vector<WorldSpring> springs;
    const ContactStepReport report = stepper.step(plant, scene, {}, springs, options);
    result.deepest = std::max(result.deepest, report.contacts.max_penetration);
    EXPECT_TRUE(report.step.finite);
  }
  result.last_speed = plant.motion[1].velocity.norm() + 0.03 * plant.motion[1].angular_velocity.norm();
  return result;
}

TEST(Contacts, AStickDroppedOnTheGroundComesToRest) {
  Plant plant = loose_stick({0, 0.1, 0}, kLying * Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())));
  const Course fall = run(plant, {{}, 0.0}, 200);
  // From 10 cm it arrives at 1.4 m/s.
  EXPECT_LT(fall.deepest, 2e-3);
  const Vec3 rest = plant.motion[1].position;
  EXPECT_LT(run(plant, {{}, 0.0}, 80).last_speed, 1e-4) << "m/s";
  EXPECT_LT((plant.motion[1].position - rest).norm(), 1e-4) << "it lies still";
  EXPECT_NEAR(rest.y(), 2e-3, 2e-4) << "on its own radius";
}

TEST(Contacts, RestingDepthIsAFractionOfAMillimetre) {
  Plant plant = loose_stick({0, 2e-3, 0}, kLying);
  run(plant, {{}, 0.0}, 200);
  EXPECT_LT(run(plant, {{}, 0.0}, 100).deepest, 1e-4);
}

TEST(Contacts, FrictionHoldsOnAGentleSlopeAndNotOnASteepOne) {
  // Tilted gravity on level ground; friction 0.6 holds to 31°.
  for (const double degrees : {20.0, 45.0}) {
    Plant plant = loose_stick({0, 2e-3, 0}, kLying);
    run(plant, {{}, 0.0}, 40);
    const Vec3 start = plant.motion[1].position;
    const double slope = degrees * kPi / 180;
    run(plant, {{}, 0.0}, 40, 9.81 * Vec3(0, -std::cos(slope), std::sin(slope)));  // 1 s
    const double slid = (plant.motion[1].position - start).norm();
    // Below its limit friction creeps at 2 mm/s at most; above, a = g (sin 45° - 0.6 cos 45°) = 2.8 m/s²: 1.4
    // m.
    if (degrees < 31) {
      EXPECT_LT(slid, 3e-3);
    } else {
      EXPECT_GT(slid, 0.7);
    }
  }
}

TEST(Contacts, NothingPassesAThinWallAtModerateSpeed) {
  const SdfObstacle wall(box_mesh({-1, -1, -0.03}, {1, 1, 0}));
  const SdfObstacle* solids[] = {&wall};
  for (const double speed : {0.5, 2.0, 4.0}) {  // m/s: up to 100 mm a step
    Plant plant = loose_stick({0, 0, 0.15}, Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX())));
    plant.motion[1].velocity = {0, 0, -speed};
    const Course result = run(plant, {solids, {}}, 60, Vec3::Zero());
    EXPECT_GT(plant.motion[1].position.z(), 0) << speed;
    // What contacts.cpp derives for an impact, v Δt / 6 for one step; 2 mm up to 0.5 m/s.
    EXPECT_LT(result.deepest, std::max(2e-3, speed * 0.025 / 6)) << speed;
  }
}

TEST(Contacts, TheEdgeOfABladeCountsNotItsMiddle) {
  const SdfObstacle wall(box_mesh({-1, -1, -0.2}, {1, 1, 0}));
  const SdfObstacle* solids[] = {&wall};
  Plant plant = loose_stick({0, 0, 0.005}, Quat::Identity());
  plant.branches[0].kind = DomainKind::Leaf;
  plant.particles[1].half_width = 0.02;
  plant.particles[1].half_thickness = 1e-4;
  Contacts contacts;
  plant.motion[1].position.z() = 1;
  EXPECT_EQ(contacts.measure(plant, {solids, {}}).max_penetration, 0);
  plant.motion[1].position.z() = 0.005;
  EXPECT_EQ(contacts.measure(plant, {solids, {}}).max_penetration, 0) << "flat before the wall";
  plant.motion[1].orientation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));
  EXPECT_NEAR(contacts.measure(plant, {solids, {}}).max_penetration, 0.015, 1e-4) << "edge on";
}

TEST(Contacts, ABladeBesideAConvexEdgeIsFree) {
  const SdfObstacle wall(box_mesh({-1, -1, -0.2}, {1, 0, 0}));
  const SdfObstacle* solids[] = {&wall};
  // Lying level 2 mm above the top, its middle 1 mm out over the edge.
  Plant plant = loose_stick({0, 0.002, 0.001}, Quat(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX())));
  plant.branches[0].kind = DomainKind::Leaf;
  plant.particles[1].half_width = 0.02;
  plant.particles[1].half_thickness = 1e-4;
  Contacts contacts;
  EXPECT_LT(contacts.measure(plant, {solids, {}}).max_penetration, 1e-3);
}

TEST(Contacts, RootsAndWhatIsBuriedWithThemAreLeftAlone) {
  Plant plant = loose_stick({0, -0.05, 0}, Quat::Identity());
  plant.motion[0].position = {0, -0.1, 0};
  Contacts contacts;
  std::vector<WorldSpring> springs;
  const ContactReport report = contacts.gather(plant, {{}, 0.0}, springs);
  EXPECT_EQ(report.exempt, 2u);
  EXPECT_EQ(report.contacts, 0u);
  EXPECT_EQ(report.max_penetration, 0);
}

}  // namespace
}  // namespace liana
