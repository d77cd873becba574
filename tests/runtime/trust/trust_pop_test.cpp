// Growing and cutting recalibrate a plant that is bent and moves, and nobody sees it.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/growth/climber.h"
#include "runtime/growth/embodiment/grown_weight.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/joints.h"
#include "tests/support/scenes/climber_scene.h"

namespace liana {
namespace {

class BentClimber : public ::testing::Test {
 protected:
  explicit BentClimber(const ClimberParameters& p = parameters()) : climber_(p, law(), Vec3::Zero(), 5) {
    for (int i = 0; i < 360; ++i) step(true);
    for (const Particle& p : plant_.particles) load_.push_back({.force = p.mass * Vec3(2, 0, 1)});
    for (int i = 0; i < 1200; ++i) step(false);
  }
  void step(bool grow) {
    if (grow) climber_.grow(plant_, {}, Vec3::UnitY(), plant_.scheme.dt);
    std::vector<Wrench> wrenches = load_;  // what has grown since is not pulled at
    wrenches.resize(plant_.particles.size());
    stepper_.step(plant_, wrenches, {}, {});
  }
  /// Lets the plant go; the largest speed of each particle within two seconds, m/s.
  std::vector<double> swing() const {
    Plant plant = plant_;
    PlantStepper stepper;
    std::vector<double> speeds(plant.motion.size(), 0);
    for (int i = 0; i < 80; ++i) {
      stepper.step(plant, {}, {}, {});
      for (size_t k = 0; k < speeds.size(); ++k)
        speeds[k] = std::max(speeds[k], plant.motion[k].velocity.norm());
    }
    return speeds;
  }
  static SpeciesLaw law() {  // stands by itself
    SpeciesLaw law = ivy_like_law();
    for (auto& [name, group] : law.groups) group.reference_frequency *= name == "leaf" ? 1 : 1.5;
    return law;
  }
  static ClimberParameters parameters() {
    ClimberParameters p;
    p.first_shoots = 3;
    p.longest_free = 1.2;
    p.branching.probability = 0.1;
    return p;
  }

  Plant plant_;
  Climber climber_;
  PlantStepper stepper_;
  std::vector<Wrench> load_;
};

Plant carrying(Plant plant) {
  std::vector<RestPose> work;
  carry_grown_weight(plant, Vec3(0, -9.81, 0), work);
  return plant;
}

/// Stiffness and damping as before; what the joints exert stays.
Plant not_recalibrated(Plant plant, const Plant& before) {
  for (size_t i = 0; i < before.particles.size(); ++i) {
    const Particle& was = before.particles[i];
    set_stiffness(plant, ParticleId(i), was.joint.shear_stiffness, was.joint.bend_stiffness);
    plant.particles[i].mass_damping = was.mass_damping;
    plant.particles[i].stiffness_damping = was.stiffness_damping;
  }
  return plant;
}

// N·m, about the joint.
Vec3 moment(const Plant& plant, size_t i) {
  const auto pose = [&](ParticleId p) {
    const Motion& m = plant.motion[p.index()];
    return BodyPose{.position = m.position, .orientation = m.orientation};
  };
  const Particle& p = plant.particles[i];
  const JointStrain e =
      joint_strain(p.joint, p.parent.valid() ? pose(p.parent) : BodyPose(), pose(ParticleId(i)));
  return p.joint.bend_stiffness.cwiseProduct(e.bend.vector) - p.joint.rest_moment;
}

TEST_F(BentClimber, ExertsAfterACutWhatItDidButForTheWeight) {
  size_t changed = 0;
  for (size_t b = 3; b < plant_.branches.size(); b += 7) {
    Plant cut = plant_;
    Climber climber = climber_;
    const Remap change = remove_subtree(cut, plant_.branches[b].particles.front());
    const size_t left = cut.particles.size();
    climber.grow(cut, {}, Vec3::UnitY(), 0);
    const Plant weight = carrying(cut), weight_before = carrying(plant_);
    for (size_t i = 0; i < plant_.particles.size(); ++i) {
      const ParticleId now = change.particles[i];
      if (!now.valid()) continue;
      ASSERT_LT(now.index(), left);
      const Joint &joint = cut.particles[now.index()].joint, &was = plant_.particles[i].joint;
      changed += std::abs(joint.bend_stiffness.x() / was.bend_stiffness.x() - 1) > 1e-3;
      const Vec3 by_weight =
          weight.particles[now.index()].joint.rest_moment - weight_before.particles[i].joint.rest_moment;
      const Vec3 bend = was.bend_stiffness.cwiseProduct(Vec3::Constant(1e-9));
      const Vec3 off = moment(cut, now.index()) + by_weight - moment(plant_, i);
      EXPECT_LT((off.cwiseAbs() - bend).maxCoeff(), 0) << "particle " << i << " of branch cut " << b;
    }
  }
  EXPECT_GT(changed, 50u) << "cuts do change stiffnesses";
}

// Against the same plant grown alike with the stiffness and damping it had before; the load bends it by as
// much as a swing.
TEST_F(BentClimber, RecalibratedTipsJumpByLessThanAHundredthOfTheirSwing) {
  const std::vector<double> speeds = swing();
  double stems = 0, leaves = 0;
  size_t recalibrated = 0;
  for (int i = 0; i < 40; ++i) {
    Plant grown = plant_;
    recalibrated += climber_.grow(grown, {}, Vec3::UnitY(), plant_.scheme.dt).recalibrated;
    Plant alone = not_recalibrated(grown, plant_);
    std::vector<Wrench> wrenches = load_;
    wrenches.resize(grown.particles.size());
    PlantStepper().step(alone, wrenches, {}, {});
    PlantStepper().step(grown, wrenches, {}, {});
    for (const Branch& branch : plant_.branches) {
      const size_t tip = branch.particles.back().index();
      if (tip >= speeds.size()) continue;
      const double jump = (grown.motion[tip].velocity - alone.motion[tip].velocity).norm() / speeds[tip];
      double& worst = branch.kind == DomainKind::Leaf ? leaves : stems;
      worst = std::max(worst, jump);
    }
    plant_ = grown;
  }
  EXPECT_GT(recalibrated, 1000u);
  EXPECT_LT(stems, 0.01);
  EXPECT_LT(leaves, 0.01);
  RecordProperty("worst_jump_of_a_stem", std::to_string(stems));
  RecordProperty("worst_jump_of_a_leaf", std::to_string(leaves));
}

/// Its tips and leaves keep to their course: one that turns towards the light moves what bears it.
class BentStraightClimber : public BentClimber {
 protected:
  BentStraightClimber() : BentClimber(straight()) {}
  static ClimberParameters straight() {
    ClimberParameters p = parameters();
    p.tropisms.surface_adaption = p.tropisms.phototropism = p.tropisms.climbing = p.tropisms.wander = 0;
    p.leaves.phototropism = 0;
    return p;
  }
  /// A second of growth, each step against the plant left as it is in that step: the largest difference of a
  /// tip's velocity, over the fastest it swings.
  double jump_by_growth(bool loaded) {
    const std::vector<double> speeds = swing();
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
      Plant same = plant_;
      climber_.grow(plant_, {}, Vec3::UnitY(), plant_.scheme.dt);
      std::vector<Wrench> load(loaded ? load_ : std::vector<Wrench>()), grown_load = load;
      load.resize(same.particles.size()), grown_load.resize(plant_.particles.size());
      PlantStepper().step(same, load, {}, {});
      PlantStepper().step(plant_, grown_load, {}, {});
      for (const Branch& branch : same.branches) {
        const size_t tip = branch.particles.back().index();
        if (tip >= speeds.size()) continue;
        const Vec3 change = plant_.motion[tip].velocity - same.motion[tip].velocity;
        worst = std::max(worst, change.norm() / speeds[tip]);
      }
    }
    return worst;
  }
};

// Nodes, leaves and lateral shoots are born, stems thicken, leaves unfold.
TEST_F(BentStraightClimber, GrowsWhileItIsHeldBentWithoutAJump) {
  const size_t before = plant_.particles.size();
  EXPECT_LT(jump_by_growth(true), 0.01);
  EXPECT_GT(plant_.particles.size(), before + 50);
}

// Here what is born has to be swung along: a leaf has 4 % of its later mass at once, a tenth of the segment's
// that bears it.
TEST_F(BentStraightClimber, GrowsWhileItSwingsWithHardlyAJump) {
  const size_t before = plant_.particles.size();
  EXPECT_LT(jump_by_growth(false), 0.025);
  EXPECT_GT(plant_.particles.size(), before + 50);
}

// As above, in the steps after a cut, which takes weight from all that bore it.
TEST_F(BentClimber, RecalibratedTipsJumpAsLittleAfterACut) {
  const std::vector<double> speeds = swing();
  double worst = 0;
  size_t recalibrated = 0, cuts = 0;
  for (size_t b = 3; b < plant_.branches.size(); b += 23, ++cuts) {
    Plant cut = plant_;
    Climber climber = climber_;
    const Remap change = remove_subtree(cut, plant_.branches[b].particles.front());
    std::vector<Wrench> load;
    for (size_t i = 0; i < load_.size(); ++i)
      if (change.particles[i].valid()) load.push_back(load_[i]);
    for (int i = 0; i < 4; ++i) {
      const Plant before = cut;
      recalibrated += climber.grow(cut, {}, Vec3::UnitY(), plant_.scheme.dt).recalibrated;
      Plant alone = not_recalibrated(cut, before);
      load.resize(cut.particles.size());
      PlantStepper().step(alone, load, {}, {});
      PlantStepper().step(cut, load, {}, {});
      for (const Branch& branch : plant_.branches) {
        const size_t tip = branch.particles.back().index();
        if (tip >= change.particles.size() || !change.particles[tip].valid()) continue;
        const size_t now = change.particles[tip].index();
        worst = std::max(worst, (cut.motion[now].velocity - alone.motion[now].velocity).norm() / speeds[tip]);
      }
    }
  }
  EXPECT_GT(cuts, 5u);
  EXPECT_GT(recalibrated, 100u);
  EXPECT_LT(worst, 0.01);
  RecordProperty("worst_jump_after_a_cut", std::to_string(worst));
}

}  // namespace
}  // namespace liana
