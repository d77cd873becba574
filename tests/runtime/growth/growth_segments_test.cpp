#include <gtest/gtest.h>

#include "runtime/growth/embodiment/grown_weight.h"
#include "runtime/growth/embodiment/thickening.h"
#include "runtime/growth/segments.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/step/joints.h"
#include "runtime/sim/step/time_step.h"

namespace liana {
namespace {

/// A chain of three from the ground, each turned a little against the last, with stiff joints.
Plant chain() {
  Plant plant;
  plant.branches.resize(1);
  Attachment at{ParticleId(), Vec3(0.1, 0, 0)};
  for (int i = 0; i < 3; ++i) {
    const Quat orientation(Eigen::AngleAxisd(0.3 * i, Vec3(1, 0, 0.5).normalized()));
    const ParticleId id = append_segment(plant, BranchId(0), at, {0.02, 0.002, 0.002}, orientation);
    Particle& particle = plant.particles[id.index()];
    set_mass(particle, DomainKind::Branch, 800);
    set_section(particle.joint, rod_section(3e9, 0.3, 0.002, 0.002, 1), 0.04);
    at = {id, Vec3(0, 0.02, 0)};
  }
  return plant;
}

JointStrain strain(const Plant& plant, size_t i) {
  const auto pose = [&](size_t k) {
    return BodyPose{.position = plant.motion[k].position, .orientation = plant.motion[k].orientation};
  };
  const ParticleId parent = plant.particles[i].parent;
  return joint_strain(plant.particles[i].joint, parent.valid() ? pose(parent.index()) : BodyPose(), pose(i));
}

TEST(Segments, FollowEachOtherHeadToTail) {
  const Plant plant = chain();
  for (size_t i = 1; i < 3; ++i) {
    const Vec3 tail = plant.motion[i].position - 0.02 * forward_of(plant, ParticleId(i));
    EXPECT_LT((tail - head_of(plant, ParticleId(i - 1))).norm(), 1e-12);
  }
}

TEST(Segments, LengtheningMovesTheHeadOnly) {
  Plant plant = chain();
  const Vec3 joint = joint_point_of(plant, ParticleId(2)), head = head_of(plant, ParticleId(2));
  lengthen_segment(plant, ParticleId(2), 0.01);
  EXPECT_LT((joint_point_of(plant, ParticleId(2)) - joint).norm(), 1e-12);
  EXPECT_LT((head_of(plant, ParticleId(2)) - head - 0.01 * forward_of(plant, ParticleId(2))).norm(), 1e-12);
  EXPECT_LT(strain(plant, 2).shear.norm(), 1e-12);
}

TEST(Segments, TurningIsPlastic) {
  Plant plant = chain();
  // Bend the last joint elastically first: growth must neither load nor relieve it.
  const Vec3 joint = joint_point_of(plant, ParticleId(2));
  Motion& tip = plant.motion[2];
  tip.orientation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitZ())) * tip.orientation;
  tip.position = joint - tip.orientation * plant.particles[2].joint.on_self;
  const double bent = strain(plant, 2).bend.vector.norm();
  const Quat growth(Eigen::AngleAxisd(0.4, Vec3(0.2, 1, -0.3).normalized()));
  const Vec3 wanted = growth * forward_of(plant, ParticleId(2));
  turn_segment(plant, ParticleId(2), growth);
  EXPECT_LT((forward_of(plant, ParticleId(2)) - wanted).norm(), 1e-12);
  EXPECT_NEAR(strain(plant, 2).bend.vector.norm(), bent, 1e-9);
  EXPECT_LT(strain(plant, 2).shear.norm(), 1e-12);
}

TEST(Segments, ANewOneMovesWithItsParent) {
  Plant plant = chain();
  plant.motion[2].velocity = {1, 2, 3};
  plant.motion[2].angular_velocity = {0, 0, 5};
  const Attachment at{ParticleId(2), Vec3(0, 0.02, 0)};
  const ParticleId id =
      append_segment(plant, BranchId(0), at, {0.01, 0.001, 0.001}, plant.motion[2].orientation);
  const Vec3 lever = plant.motion[id.index()].position - plant.motion[2].position;
  EXPECT_LT((plant.motion[id.index()].velocity - Vec3(1, 2, 3) - Vec3(0, 0, 5).cross(lever)).norm(), 1e-12);
}

TEST(GrownWeight, APlantStandsAsItGrew) {
  Plant plant = chain();
  std::vector<RestPose> rest;
  carry_grown_weight(plant, {0, -9.81, 0}, rest);
  const MotionArray start = plant.motion;
  PlantStepper stepper;
  for (int i = 0; i < 40; ++i) stepper.step(plant, {}, {}, {});
  for (size_t i = 0; i < 3; ++i) EXPECT_LT((plant.motion[i].position - start[i].position).norm(), 1e-9);
}

TEST(GrownWeight, APushedPlantComesBackToWhereItGrew) {
  Plant plant = chain();
  for (Particle& particle : plant.particles) particle.stiffness_damping = 0.05;
  const Vec3 grown = head_of(plant, ParticleId(2));
  PlantStepper stepper;
  std::vector<RestPose> rest;
  for (int i = 0; i < 400; ++i) {
    carry_grown_weight(plant, {0, -9.81, 0}, rest);  // each step, as growth does
    const std::vector<Wrench> push(3, {.force = {i < 100 ? 5.0 : 0.0, 0, 0}});
    stepper.step(plant, push, {}, {});
    if (i == 99) {
      EXPECT_GT((head_of(plant, ParticleId(2)) - grown).norm(), 1e-3) << "it was pushed";
    }
  }
  EXPECT_LT((head_of(plant, ParticleId(2)) - grown).norm(), 1e-6);
}

TEST(PipeModel, CarriesTheSumOfWhatIsAbove) {
  Plant plant = chain();
  plant.branches.resize(3);
  append_segment(plant, BranchId(1), {ParticleId(1), Vec3(0, 0.02, 0)}, {0.02, 0.001, 0.001},
                 Quat::Identity());
  plant.branches[2].kind = DomainKind::Leaf;
  append_segment(plant, BranchId(2), {ParticleId(2), Vec3(0, 0.02, 0)}, {0.02, 0.02, 1e-4}, Quat::Identity());
  const std::vector<double> r = pipe_radii(plant, {1e-3, 1e-3, 1e-3, 1e-3, 0}, 2, 5e-4);
  EXPECT_NEAR(r[2], 1e-3, 1e-12) << "a leaf's strand is less than the tip itself";
  EXPECT_NEAR(r[3], 1e-3, 1e-12);
  EXPECT_NEAR(r[1], std::sqrt(2.0) * 1e-3, 1e-12);
  EXPECT_NEAR(r[0], r[1], 1e-12);
  EXPECT_EQ(r[4], 0);
}

TEST(Thickening, IsLimitedAndMassFollows) {
  Plant plant = chain();
  const ElasticMaterial wood{3e9, 800, 0.3};
  plant.branches[0].material.mass_scaling = 1;
  const double before = plant.particles[0].mass;
  thicken(plant, {0.01, 0.01, 0.01}, {0.04, 0.04, 0.04}, {2, 0, 0.1}, wood, 0.5);
  EXPECT_NEAR(plant.particles[0].half_width, 0.002 * 1.05, 1e-12);
  EXPECT_NEAR(plant.particles[0].mass / before, 1.05 * 1.05, 1e-12);
  EXPECT_NEAR(plant.particles[0].joint.bend_stiffness.x(), 3e9 * kPi / 4 * std::pow(0.0021, 4) / 0.04, 1e-9);
}

}  // namespace
}  // namespace liana
