#include <gtest/gtest.h>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/free_flight.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

double mass_of(const Plant& plant) {
  double mass = 0;
  for (const Particle& p : plant.particles) mass += p.mass;
  return mass;
}

void expect_sound(const Plant& plant) {
  ASSERT_EQ(plant.motion.size(), plant.particles.size());
  size_t listed = 0;
  for (size_t b = 0; b < plant.branches.size(); ++b) {
    const Branch& branch = plant.branches[b];
    ASSERT_FALSE(branch.particles.empty());
    EXPECT_TRUE(!branch.parent.valid() || branch.parent < BranchId(b));
    for (size_t k = 0; k < branch.particles.size(); ++k, ++listed) {
      const Particle& p = plant.particles[branch.particles[k].index()];
      EXPECT_EQ(p.branch, BranchId(b));
      EXPECT_TRUE(!p.parent.valid() || p.parent < branch.particles[k]);
      if (k > 0) {
        EXPECT_EQ(p.parent, branch.particles[k - 1]);
      }
      if (k == 0 && branch.parent.valid()) {
        EXPECT_EQ(plant.particles[p.parent.index()].branch, branch.parent);
      }
    }
  }
  EXPECT_EQ(listed, plant.particles.size());
  for (const WorldSpring& anchor : plant.anchors) EXPECT_LT(anchor.particle.index(), plant.particles.size());
}

Plant swaying_tree(int branches = 4) {
  Plant plant = make_plant(test::synthetic_bake({.branches = branches}));
  plant.anchors.push_back({.particle = ParticleId(plant.particles.size() - 1), .target = {1, 1, 1}});
  plant.anchors.push_back({.particle = ParticleId(0)});
  PlantStepper stepper;
  const std::vector<Wrench> wind(plant.particles.size(), {.force = {2e-3, 0, 1e-3}});
  for (int i = 0; i < 30; ++i) stepper.step(plant, wind, {}, {});
  return plant;
}

ParticleId middle_of(const Plant& plant, size_t branch) {
  const auto& particles = plant.branches[branch].particles;
  return particles[particles.size() / 2];
}

TEST(Topology, DetachingSharesParticlesBranchesAndAnchorsBetweenTheTwo) {
  Plant plant = swaying_tree();
  const Plant before = plant;
  const ParticleId cut = middle_of(plant, 1);
  Remap change;
  DetachedFrom from;
  const Plant piece = detach_subtree(plant, cut, &change, &from);
  expect_sound(plant);
  expect_sound(piece);
  EXPECT_EQ(plant.particles.size() + piece.particles.size(), before.particles.size());
  EXPECT_GT(piece.branches.size(), 1u) << "twigs and leaves come along";
  EXPECT_NEAR(mass_of(plant) + mass_of(piece), mass_of(before), 1e-12);
  EXPECT_NEAR(subtree_mass(before, cut), mass_of(piece), 1e-12);
  EXPECT_NEAR(plant.branches[1].length + piece.branches[0].length, before.branches[1].length, 1e-12);
  EXPECT_EQ(plant.anchors.size() + piece.anchors.size(), before.anchors.size());
  EXPECT_TRUE(is_free(piece));
  EXPECT_FALSE(is_free(plant));
  for (size_t i = 0; i < before.motion.size(); ++i) {
    if (const ParticleId now = change.particles[i]; now.valid()) {
      EXPECT_EQ(plant.motion[now.index()].position, before.motion[i].position);
    }
  }
  for (size_t i = 0; i < piece.motion.size(); ++i)
    EXPECT_EQ(piece.motion[i].velocity, before.motion[from.particles[i].index()].velocity);
}

TEST(Topology, WhatStaysMovesOnAsIfItHadBeenAlone) {
  Plant whole = swaying_tree();
  whole.anchors.clear();
  Plant cut = whole;
  PlantStepper stepper;  // one that knew the whole tree
  for (int i = 0; i < 3; ++i) stepper.step(cut, {}, {}, {}), stepper.step(whole, {}, {}, {});
  remove_subtree(cut, cut.branches[2].particles.front());
  remove_subtree(whole, whole.branches[2].particles.front());
  for (int i = 0; i < 40; ++i) {
    const StepReport report = stepper.step(cut, {}, {}, {});
    EXPECT_EQ(report.redone, 0);
    PlantStepper().step(whole, {}, {}, {});
  }
  EXPECT_EQ(state_hash(cut), state_hash(whole)) << "a stepper's past leaves no trace";
}

TEST(Topology, AppendedBranchIsTheOneThatWasTakenAway) {
  Plant plant = swaying_tree(2);
  const BranchId last(plant.branches.size() - 1);
  const Branch branch = plant.branches[last.index()];
  ParticleArray particles;
  MotionArray motion;
  for (const ParticleId p : branch.particles) {
    particles.push_back(plant.particles[p.index()]);
    motion.push_back(plant.motion[p.index()]);
  }
  const ParticleId at = particles.front().parent;
  const uint64_t hash = state_hash(plant);
  remove_subtree(plant, branch.particles.front());
  EXPECT_EQ(append_branch(plant, branch, at, particles, motion), last);
  expect_sound(plant);
  EXPECT_EQ(state_hash(plant), hash);
}

TEST(Topology, CarriedMassesFollowACutWithoutBeingSummedAnew) {
  Plant plant = swaying_tree();
  std::vector<double> carried = carried_masses(plant);
  const ParticleId cut = middle_of(plant, 3);
  const Particle& first = plant.particles[cut.index()];
  add_carried(plant, first.parent, first.branch, -subtree_mass(plant, cut), carried);
  const Remap change = remove_subtree(plant, cut);
  const std::vector<double> anew = carried_masses(plant);
  for (size_t i = 0; i < carried.size(); ++i) {
    if (const ParticleId now = change.particles[i]; now.valid()) {
      EXPECT_NEAR(carried[i], anew[now.index()], 1e-12);
    }
  }
}

struct Momenta {
  double mass = 0;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // about the centre of mass
};
Momenta momenta(const Plant& plant) {
  Momenta m;
  Vec3 centre = Vec3::Zero();
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    m.mass += plant.particles[i].mass;
    centre += plant.particles[i].mass * plant.motion[i].position;
    m.linear += plant.particles[i].mass * plant.motion[i].velocity;
  }
  centre /= m.mass;
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& p = plant.particles[i];
    const Motion& n = plant.motion[i];
    const Vec3 spin = n.orientation.conjugate() * n.angular_velocity;
    m.angular += p.mass * (n.position - centre).cross(n.velocity) +
                 n.orientation * p.inertia.cwiseProduct(spin).eval();
  }
  return m;
}

TEST(FreeFlight, BrokenBranchFallsTumblesAndSwingsWithItsMomentaKept) {
  Plant plant = swaying_tree();
  plant.anchors.clear();
  Plant piece = detach_subtree(plant, plant.branches[1].particles[2]);
  for (Motion& m : piece.motion) {  // thrown, one turn a second
    const Vec3 spin(0, 6, 2);
    m.angular_velocity += spin;
    m.velocity += Vec3(3, 4, 0) + spin.cross(m.position - piece.motion[0].position);
    m.acceleration = Vec3(0, -9.81, 0), m.angular_acceleration.setZero();
  }
  const Momenta start = momenta(piece);
  PlantStepper stepper;
  for (int i = 1; i <= 80; ++i) {
    ASSERT_TRUE(stepper.step(piece, {}, {}, {}).finite);
    const Momenta now = momenta(piece);
    // Rounding of stiff joints' forces, some 1e-10 of a momentum a step.
    EXPECT_LT((now.angular - start.angular).norm(), 1e-6 * start.angular.norm());
    EXPECT_LT((now.linear - start.linear - start.mass * 0.025 * i * Vec3(0, -9.81, 0)).norm(),
              1e-6 * start.linear.norm());
  }
}

// A tree grows or loses branches and is calibrated anew while it sways: how much its tips' velocities change
// against the same tree left alone, one step later.
double jump(Plant changed, const Plant& alone, const std::vector<ParticleId>& watched,
            const Remap* moved = nullptr) {
  Plant other = alone;
  PlantStepper a, b;
  a.step(changed, {}, {}, {});
  b.step(other, {}, {}, {});
  double worst = 0, fastest = 0;
  for (const ParticleId p : watched) {
    const ParticleId now = moved ? moved->particles[p.index()] : p;
    worst = std::max(worst, (changed.motion[now.index()].velocity - other.motion[p.index()].velocity).norm());
    fastest = std::max(fastest, other.motion[p.index()].velocity.norm());
  }
  return worst / fastest;
}

TEST(Topology, RecalibrationAfterGrowthDoesNotPop) {
  Plant plant = swaying_tree();
  plant.anchors.clear();
  std::vector<ParticleId> tips;
  for (const Branch& branch : plant.branches) tips.push_back(branch.particles.back());
  Plant grown = plant;
  // A branch of a twentieth more length and stiffness in its law, as a growing shoot between two
  // calibrations.
  HeldChain chain;
  const std::vector<double> carried = carried_masses(grown);
  for (size_t b = 1; b < 3; ++b) {
    grown.branches[b].length *= 1.05;
    grown.branches[b].material.frequency *= std::pow(1.05, -0.59);
    ASSERT_TRUE(recalibrate(grown, BranchId(b), carried, chain));
  }
  EXPECT_LT(jump(grown, plant, tips), 0.01);
}

}  // namespace
}  // namespace liana
