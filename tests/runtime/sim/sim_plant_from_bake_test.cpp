#include <gtest/gtest.h>

#include "mesher/base/error.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/check/standing.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

double largest_move(const MotionArray& from, const MotionArray& to) {
  double move = 0;
  for (size_t i = 0; i < from.size(); ++i) move = std::max(move, (to[i].position - from[i].position).norm());
  return move;
}

TEST(PlantFromBake, ParticlesHaveTheDomainsMass) {
  const Bake bake = test::synthetic_bake();
  const Plant plant = make_plant(bake);
  ASSERT_EQ(plant.branches.size(), bake.domains.size());
  for (size_t b = 0; b < plant.branches.size(); ++b) {
    double mass = 0;
    for (const ParticleId p : plant.branches[b].particles) {
      EXPECT_GT(plant.particles[p.index()].mass, 0);
      mass += plant.particles[p.index()].mass;
    }
    EXPECT_NEAR(mass, bake.domains[b].mass, 1e-12 * mass);
  }
}

TEST(PlantFromBake, ChainsFollowTheirCentrelinesAndParentsComeFirst) {
  const Bake bake = test::synthetic_bake();
  const Plant plant = make_plant(bake);
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    if (!p.parent.valid()) continue;
    EXPECT_LT(p.parent.index(), i);
    const Motion &m = plant.motion[i], &up = plant.motion[p.parent.index()];
    EXPECT_LT(joint_gap(p.joint, up.position, up.orientation, m.position, m.orientation), 1e-12);
  }
  for (size_t b = 0; b < plant.branches.size(); ++b) {
    const size_t tip = plant.branches[b].particles.back().index();
    const Motion& m = plant.motion[tip];
    const Vec3 head = m.position + m.orientation * Vec3(0, plant.particles[tip].half_length, 0);
    EXPECT_LT((head - bake.domains[b].centreline.back().position).norm(), 1e-12);
  }
}

TEST(PlantFromBake, FlatDomainsBendTowardsTheirFlatNormal) {
  const Bake bake = test::synthetic_bake();
  const Plant plant = make_plant(bake);
  for (const Branch& branch : plant.branches) {
    if (branch.kind != DomainKind::Leaf) continue;
    const Vec3 z = plant.motion[branch.particles[0].index()].orientation * Vec3::UnitZ();
    EXPECT_GT(std::abs(z.dot(bake.domains[branch.domain.index()].flat_normal)), 0.9);
  }
}

TEST(PlantFromBake, StandsMotionlessUnderGravityExactlyAsModelled) {
  Plant plant = make_plant(test::synthetic_bake());
  const MotionArray modelled = plant.motion;
  PlantStepper stepper;
  for (int i = 0; i < 400; ++i) {  // 10 s
    const StepReport report = stepper.step(plant, {}, {}, {});
    ASSERT_TRUE(report.finite);
    ASSERT_EQ(report.redone, 0);
  }
  EXPECT_LT(largest_move(modelled, plant.motion), 1e-6);  // the bar is 1e-3; only rounding acts
}

TEST(Standing, TellsAPlantThatStandsFromOneThatTopples) {
  // A rigid rod of height l on a hinge of its frequency stands when (2πν)² > 3g/2l: above 0.61 Hz for 1 m. A
  // flexible one needs a little more (Greenhill's column: 0.63 Hz).
  Progress silent;
  const Standing firm = check_standing(make_plant(test::rod_bake({.frequency = 0.75})), silent);
  EXPECT_TRUE(firm.stable);
  EXPECT_LT(firm.moved, 1e-6);
  EXPECT_FALSE(check_standing(make_plant(test::rod_bake({.frequency = 0.5})), silent).stable);
  EXPECT_TRUE(check_standing(make_plant(test::rod_bake({.frequency = 0.5})), silent, {0, 9.81, 0}).stable)
      << "but hangs";
}

TEST(PlantFromBake, ComesBackToItsModelledShapeAfterAGust) {
  Plant plant = make_plant(test::synthetic_bake());
  const MotionArray modelled = plant.motion;
  std::vector<Wrench> gust(plant.particles.size());
  for (size_t i = 0; i < gust.size(); ++i) gust[i].force = plant.particles[i].mass * Vec3(3, 0, 1);
  PlantStepper stepper;
  for (int i = 0; i < 40; ++i) stepper.step(plant, gust, {}, {});
  const double blown = largest_move(modelled, plant.motion);
  EXPECT_GT(blown, 0.01);
  for (int i = 0; i < 4000; ++i) ASSERT_TRUE(stepper.step(plant, {}, {}, {}).finite);
  EXPECT_LT(largest_move(modelled, plant.motion), 0.05 * blown);
}

TEST(PlantFromBake, PlacementMovesAndTurnsTheWholePlant) {
  const Bake bake = test::synthetic_bake({.branches = 2});
  const Plant here = make_plant(bake);
  PlacementOptions placed;
  placed.position = {3, 0, -2};
  placed.yaw = 0.7;
  Plant there = make_plant(bake, placed);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
  for (size_t i = 0; i < here.motion.size(); ++i)
    EXPECT_LT((turn * here.motion[i].position + placed.position - there.motion[i].position).norm(), 1e-12);
  const MotionArray modelled = there.motion;
  PlantStepper stepper;
  for (int i = 0; i < 100; ++i) stepper.step(there, {}, {}, {});
  EXPECT_LT(largest_move(modelled, there.motion), 1e-6);
}

TEST(PlantFromBake, DomainThatCannotBecomeAChainIsNamed) {
  const auto message = [](auto&& spoil) -> std::string {
    Bake bake = test::synthetic_bake({.branches = 1});
    spoil(bake.domains[1]);
    try {
      make_plant(bake);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([](BakedDomain& d) { d.centreline.resize(1); }).find("branch0"), std::string::npos);
  EXPECT_NE(message([](BakedDomain& d) { d.mass = 0; }).find("branch0"), std::string::npos);
  EXPECT_NE(message([](BakedDomain& d) { d.material.frequency = -1; }).find("branch0"), std::string::npos);
  EXPECT_NE(message([](BakedDomain& d) {
              for (Station& s : d.centreline) s.half_width = 0;
            }).find("branch0"),
            std::string::npos);
}

}  // namespace
}  // namespace liana
