#include <gtest/gtest.h>

#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/model/rod_section.h"

namespace liana {
namespace {

/// One free stem particle, 6 cm long and 4 mm thick, of 2 g, after a root that the world holds far above and
/// that holds nothing itself.
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

TEST(Contacts, WhatRestsOnABoxForAMinuteNeitherCreepsNorTrembles) {
  SdfObstacle box(box_mesh({-0.5, -0.5, -0.5}, {0.5, 0, 0.5}));
  const SdfObstacle* solids[] = {&box};
  Plant plant = loose_stick({0, 2e-3, 0}, kLying);
  // 15° of slope, by gravity: the pull along it is 0.45 of what friction holds.
  const Vec3 gravity = 9.81 * Vec3(0, -std::cos(0.26), std::sin(0.26));
  run(plant, {solids, {}}, 80, gravity);
  const Vec3 start = plant.motion[1].position;
  double fastest = 0;
  ContactStepper stepper;
  for (int i = 0; i < 2400; ++i) {
    std::vector<WorldSpring> springs;
    stepper.step(plant, {solids, {}}, {}, springs, {.gravity = gravity});
    if (i > 40) fastest = std::max(fastest, plant.motion[1].velocity.norm());
  }
  EXPECT_LT((plant.motion[1].position - start).norm(), 1e-4) << "m in a minute";
  EXPECT_LT(fastest, 1e-6) << "m/s";
}

TEST(Contacts, TheFrictionConeIsCoulombs) {
  // tan 30.96° = 0.6. One degree to either side: a = g (sin - 0.6 cos) = 0.20 m/s² above.
  for (const double degrees : {30.0, 32.0, 40.0}) {
    Plant plant = loose_stick({0, 2e-3, 0}, kLying);
    run(plant, {{}, 0.0}, 40);
    const Vec3 start = plant.motion[1].position;
    const double slope = degrees * kPi / 180;
    run(plant, {{}, 0.0}, 40, 9.81 * Vec3(0, -std::cos(slope), std::sin(slope)));  // 1 s
    const double slid = (plant.motion[1].position - start).norm();
    const double free = 0.5 * 9.81 * (std::sin(slope) - 0.6 * std::cos(slope));
    if (degrees < 31) {
      EXPECT_LT(slid, 1e-3);
    } else {
      EXPECT_NEAR(slid, free, 0.25 * free + 0.02) << degrees;
    }
  }
}

TEST(Contacts, AStickReboundsWithItsRestitution) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    SdfObstacle box(box_mesh({-0.5, -0.5, -0.5}, {0.5, 0, 0.5}));
    box.material.restitution = restitution;
    const SdfObstacle* solids[] = {&box};
    Plant plant = loose_stick({0, 0.2, 0}, kLying);
    plant.motion[1].velocity = {0, -2, 0};
    run(plant, {solids, {}}, 12, Vec3::Zero());
    EXPECT_NEAR(plant.motion[1].velocity.y(), 2 * restitution, 0.05) << restitution;
  }
}

TEST(Contacts, AMovingBoxPushesAndCarriesWhatLiesOnIt) {
  SdfObstacle box(box_mesh({-0.2, -0.1, -0.2}, {0.2, 0, 0.2}));
  const SdfObstacle* solids[] = {&box};
  Plant plant = loose_stick({0, 2e-3, 0}, kLying);
  run(plant, {solids, {}}, 40);
  ContactStepper stepper;
  // Sideways and up, gaining speed at 1 m/s² sideways: less than friction's 5.9.
  const double dt = plant.scheme.dt;
  Vec3 velocity(0, 0, 0);
  ObstaclePose pose;
  double deepest = 0;
  for (int i = 0; i < 40; ++i) {
    velocity += dt * Vec3(1, 0.5, 0);
    pose.position = pose.centre = Vec3(pose.position + dt * velocity);
    pose.velocity = velocity;
    box.place(pose);
    std::vector<WorldSpring> springs;
    const auto report = stepper.step(plant, {solids, {}}, {}, springs, {});
    deepest = std::max(deepest, report.contacts.max_penetration);
  }
  EXPECT_LT((plant.motion[1].position - pose.position - Vec3(0, 2e-3, 0)).norm(), 5e-3)
      << "a fifth of its way in the last step";
  EXPECT_NEAR((plant.motion[1].velocity - velocity).norm(), 0, 0.03);
  EXPECT_LT(deepest, 1e-3);
}

TEST(Contacts, AreTheSameSeenFromAMovingFrame) {
  // Gently, deep inside, hard and elastic, and sliding; the box's frame moves up, down and sideways.
  struct Case {
    double height;
    Vec3 velocity;
    double restitution;
  };
  for (const Case& c : {Case{2e-3, Vec3::Zero(), 0}, Case{-0.02, Vec3::Zero(), 0}, Case{0.1, {0, -3, 0}, 0.5},
                        Case{1e-3, {0.4, -0.2, 0}, 0}})
    for (const Vec3& frame : {Vec3(0, 0.5, 0), Vec3(0, -0.5, 0), Vec3(0.7, -0.2, 0.1)}) {
      // Tilted: of a stick that lies flat, rounding decides which point comes first.
      const Quat tilted(Eigen::AngleAxisd(kPi / 2 + 0.05, Vec3::UnitZ()));
      Plant at_rest = loose_stick({0, c.height, 0}, tilted);
      at_rest.particles[0].joint.shear_stiffness.setZero();  // the world holds nothing: none is exempt
      Plant carried = at_rest;
      at_rest.motion[1].velocity = c.velocity;
      carried.motion[0].velocity = frame;
      carried.motion[1].velocity = c.velocity + frame;
      SdfObstacle still(box_mesh({-0.5, -0.5, -0.5}, {0.5, 0, 0.5})), box(still.mesh());
      still.material.restitution = box.material.restitution = c.restitution;
      const SdfObstacle *of_still[] = {&still}, *of_box[] = {&box};
      ContactStepper one, other;
      ObstaclePose pose;
      for (int i = 1; i <= 20; ++i) {
        std::vector<WorldSpring> springs, more;
        one.step(at_rest, {of_still, {}}, {}, springs, {});
        pose.position = i * at_rest.scheme.dt * frame;
        pose.centre = pose.position;
        pose.velocity = frame;
        box.place(pose);
        other.step(carried, {of_box, {}}, {}, more, {});
        const Vec3 along = at_rest.scheme.dt * frame * i;
        ASSERT_LT((carried.motion[1].position - along - at_rest.motion[1].position).norm(), 1e-7)
            << "step " << i << ", height " << c.height << ", frame " << frame.transpose();
      }
    }
}

TEST(Contacts, AThinBarIsNotPassedWhereverItMeetsTheStick) {
  // 1 cm, square; up to 5 m/s: 12 bars in a step. The stick hardly turns: struck beside its middle, it would
  // else swing round the bar.
  const SdfObstacle bar(box_mesh({-1, -0.005, -0.005}, {1, 0.005, 0.005}));
  const SdfObstacle* solids[] = {&bar};
  for (const double speed : {0.5, 2.0, 5.0})
    for (const double along : {-0.026, -0.015, 0.0, 0.012, 0.028}) {
      Plant plant = loose_stick({0, along, 0.2}, Quat::Identity());  // upright, moving level
      plant.motion[1].velocity = {0, 0, -speed};
      plant.particles[1].inertia *= 1e4;
      ContactStepper stepper;
      bool behind = false;
      for (int i = 0; i < 80; ++i) {
        std::vector<WorldSpring> springs;
        stepper.step(plant, {solids, {}}, {}, springs, {.gravity = Vec3::Zero()});
        const Vec3 axis = plant.motion[1].orientation * Vec3::UnitY();
        const double s = std::abs(axis.y()) > 1e-3 ? -plant.motion[1].position.y() / axis.y() : 1;
        if (std::abs(s) < 0.029) behind |= (plant.motion[1].position + s * axis).z() < 0;
      }
      EXPECT_FALSE(behind) << speed << " m/s, " << along << " m from its middle";
    }
}

TEST(Contacts, WhatPassesByABarIsNotTouched) {
  const SdfObstacle bar(box_mesh({-1, -0.005, -0.005}, {1, 0.005, 0.005}));
  const SdfObstacle* solids[] = {&bar};
  Plant plant = loose_stick({0, 0.025, 0.2}, kLying);
  plant.motion[1].velocity = {0, 0, -5};
  run(plant, {solids, {}}, 4, Vec3::Zero());
  EXPECT_NEAR(plant.motion[1].position.z(), -0.3, 1e-9);
}

TEST(Contacts, ABladeThatABarPiercesKeepsToOneWayOut) {
  // The bar lies along x, the blade nearly across it: a millimetre decides which of the bar's faces is
  // nearest.
  const SdfObstacle bar(box_mesh({-1, -0.005, -0.005}, {1, 0.005, 0.005}));
  const SdfObstacle* solids[] = {&bar};
  Plant plant = loose_stick({0, 0, 1}, Quat(Eigen::AngleAxisd(1.3, Vec3::UnitY())) *
                                           Quat(Eigen::AngleAxisd(kPi / 2 - 0.2, Vec3::UnitX())));
  plant.branches[0].kind = DomainKind::Leaf;
  plant.particles[1].half_width = 0.02;
  plant.particles[1].half_thickness = 1e-4;
  const Vec3 axis = plant.motion[1].orientation * Vec3::UnitY(),
             across = plant.motion[1].orientation * Vec3::UnitZ();
  Contacts contacts;
  std::vector<WorldSpring> springs;
  contacts.gather(plant, {solids, {}}, springs);  // what is inside at first would belong there
  std::vector<double> ways;
  for (const double off : {0.0015, -0.0015, 0.0015, -0.0015}) {
    springs.clear();
    plant.motion[1].position = Vec3(0, off, 0) - 0.015 * axis;
    contacts.gather(plant, {solids, {}}, springs);
    for (const WorldSpring& spring : springs) {
      if (std::abs(spring.on_particle.y() - 0.015) > 0.01) continue;  // of its middle or an end
      const Vec3 x = plant.motion[1].position + plant.motion[1].orientation * spring.on_particle;
      ways.push_back((spring.target - x).dot(across));
    }
  }
  ASSERT_EQ(ways.size(), 4u);
  for (const double way : ways) EXPECT_GT(way * ways[0], 0);
}

TEST(Contacts, WhatIsWedgedInIsPushedNoHarderThanItsJointBears) {
  // A light shoot that cannot bend, 2 mm in a wall, on a joint of 100 N/m: 5 kN/m would open it by 2 mm
  // of 60.
  const SdfObstacle wall(box_mesh({-1, -1, -0.2}, {1, 1, 0}));
  const SdfObstacle* solids[] = {&wall};
  Plant plant = loose_stick({0, 0, 0}, Quat::Identity());
  for (Particle& particle : plant.particles) {
    particle.mass = 1e-4;
    particle.inertia = rod_inertia(1e-4, 0.03, 2e-3, 2e-3);
    particle.joint.bend_stiffness = Vec3::Constant(10);
    particle.joint.on_self = {0, -0.03, 0};
  }
  plant.particles[0].joint.on_parent = {0, -0.09, 0};
  plant.particles[0].joint.shear_stiffness = Vec3::Constant(1e6);
  plant.particles[1].joint.on_parent = {0, 0.03, 0};
  plant.particles[1].joint.shear_stiffness = Vec3::Constant(100);
  plant.motion[0].position = {0, -0.06, 0};
  plant.motion[1].position = {0, 0, 0};
  const auto move = [&](double by) {
    plant.particles[0].joint.on_parent.z() += by;
    for (Motion& motion : plant.motion) motion.position.z() += by;
  };
  ContactStepper stepper;
  for (int i = 0; i < 100; ++i) {
    if (i == 0) move(0.004);  // what is inside at first belongs there
    if (i == 1) move(-0.004);
    std::vector<WorldSpring> springs;
    const ContactStepReport report =
        stepper.step(plant, {solids, {}}, {}, springs, {.gravity = Vec3::Zero()});
    ASSERT_EQ(report.step.redone, 0) << i;
  }
  EXPECT_GT(plant.motion[1].position.z(), 2e-4) << "m: it is pushed all the same";
}

}  // namespace
}  // namespace liana
