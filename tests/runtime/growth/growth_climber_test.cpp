#include <gtest/gtest.h>

#include <map>
#include <set>

#include "mesher/base/error.h"
#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/calibrate/discrete_response.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/joints.h"
#include "runtime/wind/field/sheltered_wind.h"
#include "runtime/wind/field/steady_gust_wind.h"
#include "tests/support/scenes/climber_scene.h"

namespace liana {
namespace {

/// Fewer shoots than an ivy for the eye: enough to try everything, soon done.
ClimberParameters sparse() {
  ClimberParameters parameters;
  parameters.first_shoots = 3;
  parameters.branching.probability = 0.04;
  parameters.max_particles = 1200;
  return parameters;
}

double highest(const Plant& plant) {
  double top = 0;
  for (const Motion& motion : plant.motion) top = std::max(top, motion.position.y());
  return top;
}

TEST(Climber, ReachesTheTopOfAThreeMetreWallInWind) {
  ClimberScene scene(sparse());
  GustParameters gusts;
  gusts.mean = {2.5, 0, -1};
  const SteadyGustWind open(gusts);
  const ShelteredWind wind(open, {&scene.wall}, 0.0);
  scene.run(50, &wind);

  EXPECT_GT(highest(scene.plant), 3.0);
  EXPECT_TRUE(scene.sound) << "every step finite, every joint closed";
  EXPECT_LT(scene.max_penetration, 2e-3) << "m, of any particle at any time";
  EXPECT_LT(scene.max_speed, 3) << "m/s: nothing whips";
  EXPECT_EQ(scene.out_of_range, 0u);
  // Every stem particle but the roots, the growing tips and what hangs free holds on.
  size_t stems = 0;
  double speed = 0;
  for (size_t i = 0; i < scene.plant.particles.size(); ++i) {
    stems += scene.plant.branches[scene.plant.particles[i].branch.index()].kind == DomainKind::Branch;
    speed = std::max(speed, scene.plant.motion[i].velocity.norm());
  }
  EXPECT_GT(scene.growth.anchors, stems * 8 / 10);
  EXPECT_GT(speed, 1e-3) << "m/s: it sways";
  EXPECT_GT(scene.growth.leaves, 300u);
}

TEST(Climber, StandsStillWithoutWind) {
  ClimberScene scene(sparse());
  scene.run(20);
  EXPECT_LT(scene.max_speed, 0.02) << "m/s: growth pushes nothing about, calibration does not pop";
  EXPECT_EQ(scene.redone, 0u);
  EXPECT_LT(scene.max_penetration, 5e-4);
}

TEST(Climber, GrowsTheSamePlantTwice) {
  ClimberScene first(sparse(), 5), second(sparse(), 5), other(sparse(), 6);
  first.run(8), second.run(8), other.run(8);
  EXPECT_EQ(state_hash(first.plant), state_hash(second.plant));
  EXPECT_NE(state_hash(first.plant), state_hash(other.plant));
}

TEST(Climber, EveryBranchSwingsAsItsLawSaysForItsLength) {
  ClimberScene scene(sparse());
  scene.climber.grow(scene.plant, scene.obstacles(), {0.4, 0.8, 0.45}, 0.025);
  scene.run(10);
  const SpeciesLaw law = ivy_like_law();
  const std::vector<double> carried = carried_masses(scene.plant);
  HeldChain chain;
  for (size_t i = 0; i < scene.plant.branches.size(); ++i) {
    const Branch& branch = scene.plant.branches[i];
    // What grew since its last calibration may be off by a tenth in length or mass: ν by 0.59/10 or 1/20 of
    // it.
    const DomainMaterial wanted = evaluate(law.group(branch.group), branch.length);
    chain.build(scene.plant, BranchId(i), carried);
    const UnitOscillator target =
        discrete_oscillator(wanted.frequency, wanted.damping_factor, scene.plant.scheme.substep(), 0.6);
    EXPECT_NEAR(std::sqrt(chain.lowest_eigenvalue() / target.stiffness), 1, 0.12) << branch.group << " " << i;
  }
}

TEST(Climber, OnceGrownFrequenciesAreExact) {
  ClimberParameters parameters = sparse();
  parameters.max_particles = 60;
  ClimberScene scene(parameters);
  scene.run(30);  // it stops at 60 particles after some seconds; leaves are full-grown, stems thick
  ASSERT_EQ(scene.growth.tips, 0u);
  const std::vector<double> carried = carried_masses(scene.plant);
  HeldChain chain;
  for (size_t i = 0; i < scene.plant.branches.size(); ++i) {
    const Branch& branch = scene.plant.branches[i];
    chain.build(scene.plant, BranchId(i), carried);
    const UnitOscillator target = discrete_oscillator(
        branch.material.frequency, branch.material.damping_factor, scene.plant.scheme.substep(), 0.6);
    // Changes of 0.1 % in length, mass or the first joint are calibrated away; the shape may change a little
    // more.
    EXPECT_NEAR(std::sqrt(chain.lowest_eigenvalue() / target.stiffness), 1, 5e-3) << branch.group << " " << i;
  }
}

TEST(Climber, CreepsOnLevelGroundWithoutASupport) {
  Plant plant;
  Climber climber(sparse(), ivy_like_law(), {0, 0, 0}, 3);
  GrowthReport report;
  for (int i = 0; i < 100; ++i) report = climber.grow(plant, {}, {0, 1, 0}, 0.025);
  EXPECT_GT(plant.particles.size(), 10u);
  for (const Motion& motion : plant.motion) EXPECT_GT(motion.position.y(), -1e-3);
}

TEST(Climber, FastGrowthIsCutIntoSmallSteps) {
  ClimberScene slow(sparse()), fast(sparse());
  fast.growth_speed = 8;
  slow.run(8), fast.run(1);
  // The same growth time; the random walk differs with the step.
  EXPECT_NEAR(highest(fast.plant), highest(slow.plant), 0.15);
}

void cut(ClimberScene& scene, ParticleId at) {
  const Remap change = remove_subtree(scene.plant, at);
}

/// Of every particle: the first shoot that it grows from, by its lineage.
std::vector<uint64_t> trees_of(const Plant& plant) {
  std::vector<uint64_t> tree(plant.particles.size());
  for (size_t i = 0; i < tree.size(); ++i) {
    const ParticleId parent = plant.particles[i].parent;
    tree[i] = parent.valid() ? tree[parent.index()] : plant.lineage[i].value;
  }
  return tree;
}

/// All numbers of a tree's particles and branches, by lineage.
std::map<uint64_t, std::vector<double>> numbers_of(const Plant& plant, uint64_t tree) {
  std::map<uint64_t, std::vector<double>> numbers;
  const std::vector<uint64_t> trees = trees_of(plant);
  for (size_t i = 0; i < trees.size(); ++i) {
    if (trees[i] != tree) continue;
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    const Joint& j = p.joint;
    const Branch& b = plant.branches[p.branch.index()];
    std::vector<double>& n = numbers[plant.lineage[i].value];
    for (const double x : {p.half_length, p.half_width, p.half_thickness, p.mass, p.mass_damping,
                           p.stiffness_damping, b.length, b.stiffness_scale, b.material.frequency})
      n.push_back(x);
    for (const Vec3& v :
         {m.position, m.velocity, m.angular_velocity, m.acceleration, m.angular_acceleration, p.inertia,
          j.on_parent, j.on_self, j.shear_stiffness, j.bend_stiffness, j.rest_force, j.rest_moment})
      n.insert(n.end(), v.data(), v.data() + 3);
    for (const Quat& q : {m.orientation, j.rest}) n.insert(n.end(), q.coeffs().data(), q.coeffs().data() + 4);
  }
  return numbers;
}

// One of four first shoots is cut, low or high. The others, which never met what was cut off, do not know to
// the last bit.
TEST(Climber, LeavingOutACutLeavesWhatNeverMetItBitEqual) {
  ClimberParameters parameters = sparse();
  parameters.first_shoots = 4;
  parameters.fan = 1.2;
  parameters.branching.room = 0.04;
  parameters.max_particles = 100'000;  // which all of them would share
  GustParameters gusts;
  gusts.mean = {1, 0, -0.5};
  const SteadyGustWind wind(gusts);
  for (const size_t part : {3, 6}) {  // of nine
    ClimberScene whole(parameters), cut_scene(parameters);
    whole.growth_speed = cut_scene.growth_speed = 2;
    whole.run(6, &wind), cut_scene.run(6, &wind);
    const std::vector<ParticleId>& shoot = whole.plant.branches[0].particles;
    const std::vector<uint64_t> before = trees_of(whole.plant);
    const uint64_t hurt = before[shoot[0].index()];
    const std::set<uint64_t> trees(before.begin(), before.end());
    ASSERT_EQ(trees.size(), 4u);
    cut(cut_scene, shoot[shoot.size() * part / 9]);
    std::set<uint64_t> met = {hurt};
    const size_t at_start = cut_scene.plant.particles.size();
    for (int i = 0; i < 40; ++i) {
      whole.run(0.25, &wind), cut_scene.run(0.25, &wind);
      // Who is near to what one run has of the hurt tree and the other has not: buds ask within 2.5 rooms.
      const std::vector<uint64_t> tree = trees_of(whole.plant);
      const std::set<LineageId> left(cut_scene.plant.lineage.begin(), cut_scene.plant.lineage.end());
      for (size_t a = 0; a < tree.size(); ++a)
        for (size_t b = 0; tree[a] == hurt && !left.contains(whole.plant.lineage[a]) && b < tree.size(); ++b)
          if ((whole.plant.motion[a].position - whole.plant.motion[b].position).norm() < 0.15)
            met.insert(tree[b]);
    }
    EXPECT_LT(at_start, 384u) << "and the larger plant is eliminated in parts";
    EXPECT_GT(whole.plant.particles.size(), 384u);
    EXPECT_EQ(whole.redone + cut_scene.redone, 0u) << "a step is redone for all trees of a plant at once";
    EXPECT_NE(numbers_of(whole.plant, hurt), numbers_of(cut_scene.plant, hurt));
    size_t compared = 0;
    for (const uint64_t tree : trees) {
      if (met.contains(tree)) continue;
      const auto expected = numbers_of(whole.plant, tree), found = numbers_of(cut_scene.plant, tree);
      EXPECT_EQ(expected.size(), found.size());
      EXPECT_TRUE(expected == found) << "tree " << tree << ", cut at " << part;
      compared += expected.size();
    }
    EXPECT_GT(compared, 150u) << "particles";
  }
}

TEST(Climber, GrowsOnWhereItWasNotCut) {
  ClimberScene scene(sparse());
  scene.run(12);
  // The longest first shoot is cut in its middle, another shoot off at its root, a leaf off.
  const Plant& plant = scene.plant;
  const ParticleId middle = plant.branches[0].particles[plant.branches[0].particles.size() / 2];
  cut(scene, middle);
  const double stump = plant.branches[0].length;
  const size_t stump_particles = plant.branches[0].particles.size(), left = plant.particles.size();
  for (size_t b = plant.branches.size(); b-- > 0;) {
    if (plant.branches[b].level != 0 || b == 0) continue;
    cut(scene, plant.branches[b].particles.front());
    break;
  }
  for (const Branch& branch : plant.branches)
    if (branch.kind == DomainKind::Leaf) {
      cut(scene, branch.particles.front());
      break;
    }
  EXPECT_LT(plant.particles.size(), left);
  const size_t before = plant.particles.size();
  const double height = highest(plant);
  scene.run(14);
  EXPECT_TRUE(scene.sound);
  EXPECT_EQ(plant.branches[0].particles.size(), stump_particles)
      << "a shoot without its tip is no longer one";
  EXPECT_NEAR(plant.branches[0].length, stump, 1e-9);
  EXPECT_GT(plant.particles.size(), before + 50) << "the others go on";
  EXPECT_GT(highest(plant), height + 0.3);
  bool lateral = false;
  for (const Branch& branch : plant.branches)
    lateral = lateral || (branch.kind == DomainKind::Branch && branch.parent == BranchId(0) &&
                          plant.particles[branch.particles.front().index()].parent ==
                              plant.branches[0].particles.back());
  EXPECT_TRUE(lateral) << "a bud below the cut";
  EXPECT_EQ(scene.growth.anchors, plant.anchors.size());
  size_t leaves = 0;
  for (const Branch& branch : plant.branches) leaves += branch.kind == DomainKind::Leaf;
  EXPECT_EQ(scene.growth.leaves, leaves);
}

TEST(Climber, SurvivesHundredsOfCutsAndItsEnd) {
  ClimberScene scene(sparse());
  Random random(3, "cuts");
  for (int i = 0; i < 300; ++i) {
    scene.run(0.05);
    if (i % 2 == 0) continue;
    const auto at = static_cast<size_t>(random.uniform() * double(scene.plant.particles.size()));
    if (scene.plant.particles[at].parent.valid()) cut(scene, ParticleId(at));
  }
  EXPECT_TRUE(scene.sound);
  EXPECT_LT(scene.max_speed, 3) << "m/s";
  while (!scene.plant.particles.empty()) cut(scene, ParticleId(0));
  const GrowthReport report = scene.climber.grow(scene.plant, scene.obstacles(), {0, 1, 0}, 0.025);
  EXPECT_EQ(report.tips, 0u);
  EXPECT_TRUE(scene.plant.particles.empty()) << "it does not germinate again";
}

TEST(Climber, RefusesNonsense) {
  ClimberParameters parameters;
  parameters.segment_length = -1;
  EXPECT_THROW(Climber(parameters, ivy_like_law(), Vec3::Zero(), 1), Error);
  EXPECT_THROW(Climber({}, ivy_like_law(), Vec3(std::nan(""), 0, 0), 1), Error);
  SpeciesLaw leafless = ivy_like_law();
  leafless.groups.erase("leaf");
  EXPECT_THROW(Climber({}, leafless, Vec3::Zero(), 1), Error);
}

class AnchorsOnAWall : public ::testing::Test {
 protected:
  AnchorsOnAWall() : wall(box_mesh({-1, -1, -0.2}, {1, 1, 0})) {
    plant.branches.resize(1);
    id = append_segment(plant, BranchId(0), {ParticleId(), Vec3(0, 0, 0.004)}, {0.02, 1.2e-3, 1.2e-3},
                        Quat::Identity());
  }
  SdfObstacle wall;
  const SdfObstacle* solids[1] = {&wall};
  Surroundings around{solids, Vec3::UnitY(), -10};
  Plant plant;
  ParticleId id;
  Anchors anchors{AnchorParameters{}, 1.2e-3};
};

TEST_F(AnchorsOnAWall, HoldWhatTouchesAndOnlyOnce) {
  EXPECT_TRUE(anchors.attach(plant, id, around));
  EXPECT_TRUE(anchors.attach(plant, id, around));
  EXPECT_EQ(plant.anchors.size(), 1u);
  plant.motion[0].position.z() = 0.5;
  const ParticleId far =
      append_segment(plant, BranchId(0), {id, Vec3::Zero()}, {0.02, 1e-3, 1e-3}, Quat::Identity());
  EXPECT_FALSE(anchors.attach(plant, far, around));
}

TEST_F(AnchorsOnAWall, HardenWithAgeAndWidthAndDoNotPull) {
  anchors.attach(plant, id, around);
  anchors.update(plant, 1);
  const double half = plant.anchors[0].stiffness(0, 0);
  anchors.update(plant, 5);
  const double full = plant.anchors[0].stiffness(0, 0);
  EXPECT_NEAR(half / full, 0.5, 1e-9);
  EXPECT_NEAR(full, AnchorParameters().stiffness, 1e-9);
  const Motion& motion = plant.motion[0];
  const Vec3 point = motion.position + motion.orientation * plant.anchors[0].on_particle;
  EXPECT_LT((point - plant.anchors[0].target).norm(), 1e-9) << "roots bridge the gap as it is";
  plant.particles[0].half_width = 2.4e-3;
  anchors.update(plant, 0);
  EXPECT_NEAR(plant.anchors[0].stiffness(0, 0) / full, 2, 1e-9);
}

TEST_F(AnchorsOnAWall, LetGoBeyondTheirDistance) {
  anchors.attach(plant, id, around);
  const double distance = AnchorParameters().release_distance;
  plant.motion[0].position.z() += 0.95 * distance;
  anchors.update(plant, 0.1);
  EXPECT_EQ(anchors.count(), 1u);
  plant.motion[0].position.z() += 0.1 * distance;
  anchors.update(plant, 0.1);
  EXPECT_EQ(anchors.count(), 0u);
  EXPECT_EQ(anchors.released(), 1u);
  EXPECT_TRUE(plant.anchors.empty());
  EXPECT_FALSE(anchors.holds(id));
}

TEST_F(AnchorsOnAWall, LetGoBeforeAWeakJointOpens) {
  Particle& particle = plant.particles[0];
  particle.joint.shear_stiffness = Vec3::Constant(500);
  anchors.attach(plant, id, around);
  anchors.update(plant, 100);
  const double stiffness = plant.anchors[0].stiffness(0, 0);
  const double opens = 0.02 * gap_scale(particle) * 500;  // N: the alarm of a time step
  plant.motion[0].position.z() += 0.7 * opens / stiffness;
  anchors.update(plant, 0.1);
  EXPECT_EQ(anchors.count(), 1u);
  plant.motion[0].position.z() += 0.2 * opens / stiffness;
  anchors.update(plant, 0.1);
  EXPECT_EQ(anchors.released(), 1u);
}

TEST_F(AnchorsOnAWall, ATautOneDoesNotMakeTheStemSpin) {
  Particle& particle = plant.particles[0];
  set_mass(particle, DomainKind::Branch, 800);
  particle.joint.shear_stiffness = Vec3::Constant(1000);
  particle.joint.bend_stiffness = Vec3::Constant(2e-4);
  anchors.attach(plant, id, around);
  particle.joint.on_parent += Vec3(0.004, 0, 0.004);  // it is pulled sideways and off the wall
  plant.motion[0].position += Vec3(0.004, 0, 0.004);
  PlantStepper stepper;
  double fastest = 0;
  for (int i = 0; i < 200; ++i) {
    anchors.update(plant, 0.025);
    stepper.step(plant, {}, {}, {.gravity = Vec3::Zero()});
    const Vec3 spin = plant.motion[0].orientation.conjugate() * plant.motion[0].angular_velocity;
    if (i > 100) fastest = std::max(fastest, std::abs(spin.y()));
  }
  ASSERT_EQ(anchors.count(), 1u);
  EXPECT_LT(fastest, 1e-6) << "rad/s";
}

TEST(TipGrowth, SlidesAlongWhatItMeetsSquarely) {
  // Upwards along a wall, into the corner below a ledge.
  const SdfObstacle wall(box_mesh({-1, -1, -0.2}, {1, 2, 0})),
      ledge(box_mesh({-1, 0.1, -0.1}, {1, 0.2, 0.08}));
  const SdfObstacle* solids[] = {&wall, &ledge};
  const Surroundings around{solids, Vec3(0.2, 0.9, 0.4).normalized(), -10};
  ClimberParameters parameters;
  parameters.segment_length = 0.3;
  Plant plant;
  plant.branches.resize(1);
  const double radius = parameters.tip_radius;
  const ParticleId tip = append_segment(plant, BranchId(0), {ParticleId(), Vec3(0, 0.06, radius)},
                                        {0.005, radius, radius}, Quat::Identity());
  Shoot shoot{BranchId(0), radius, 0, 1};
  const Draws turns(1, {}, "tip");
  double deepest = 0;
  for (uint64_t i = 0; i < 200 && !grow_tip(plant, shoot, parameters, around, turns.normal(i), 0.025); ++i)
    for (const SdfObstacle* solid : solids)
      deepest = std::max(deepest, radius - solid->closest_point(head_of(plant, tip)).distance);
  EXPECT_LT(deepest, 2e-3) << "m, which contacts undo";
  EXPECT_GT(2 * plant.particles[tip.index()].half_length, 0.15) << "m: it does not stop for good";
}

TEST(TipGrowth, IsFreeAsFarAsTheGround) {
  const Surroundings around{{}, Vec3::UnitY(), 0};
  const auto ground = in_the_way(around, {0, 0.02, 0}, {0, -1, 0}, 1e-3, 0.05);
  ASSERT_TRUE(ground);
  EXPECT_NEAR(ground->free, 0.019, 1e-12);
  EXPECT_FALSE(in_the_way(around, {0, 0.02, 0}, {0, -1, 0}, 1e-3, 0.01)) << "too short to reach it";
  EXPECT_FALSE(in_the_way(around, {0, 5e-4, 0}, {1, 0, 0}, 1e-3, 0.05)) << "along it";
}

}  // namespace
}  // namespace liana
