// A world's state is all that decides how it goes on: saved anywhere, loaded into a world made anew of the
// same scene, it goes on to the bit as the world that it was saved from, on any number of threads.
#include "runtime/world/world_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "mesher/base/files.h"
#include "mesher/base/random.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/world/scene/scene_file.h"
#include "runtime/world/scene/scene_solids.h"
#include "runtime/world/world.h"
#include "tests/support/scenes/busy_scene.h"

namespace liana {
namespace {

/// The scenes that come with the program, and bakes for those that need some, all where they would be.
class ShippedScenes {
 public:
  ShippedScenes() {
    std::filesystem::create_directories(folder_ / "data/scenes");
    std::filesystem::create_directories(folder_ / "demo");
    Bake bake = test::synthetic_bake({.branches = 8, .twigs = 2, .leaves = 2, .height = 2});
    bake.law = ivy_like_law();
    for (auto& [name, group] : bake.law.groups) group.modulus_of_rupture = name == "leaf" ? 1.5e7 : 3e6;
    for (size_t i = 0; i < bake.domains.size(); ++i) {
      bake.domains[i].default_frequency = bake.domains[i].material.frequency;
      bake.domains[i].name = i == 0 ? "trunk" : "branch." + std::to_string(i);
    }
    for (const char* name : {"apple_tree", "apple_small_brittle", "ivy"})
      write_bake(bake, folder_ / ("demo/" + std::string(name) + ".bake"));
    for (const auto& file : std::filesystem::directory_iterator(LIANA_SOURCE_DIR "/data/scenes")) {
      names_.push_back(file.path().stem().string());
      std::filesystem::copy(file, folder_ / "data/scenes");
    }
    std::sort(names_.begin(), names_.end());
  }
  const std::vector<std::string>& names() const { return names_; }

  /// A fifth as long: it grows faster, all that happens in it happens sooner.
  Scene hurried(const std::string& name) const {
    constexpr double kSooner = 0.2, kCoarse = 0.01;  // m
    Scene scene = with_separate_solids(read_scene(folder_ / ("data/scenes/" + name + ".toml")));
    for (SceneSolid& solid : scene.solids->pieces) solid.voxel = kCoarse;  // quickly made
    scene.seconds *= kSooner;
    for (SceneClimber& climber : scene.climbers) climber.growth_speed = 4, climber.max_particles = 300;
    for (SceneCut& cut : scene.cuts) cut.time *= kSooner;
    for (SceneGrab& grab : scene.grabs) grab.time *= kSooner, grab.seconds *= kSooner;
    for (SceneObstacle& obstacle : scene.obstacles)
      if (obstacle.motion)
        for (ObstacleMotion::Key& key : obstacle.motion->keys) key.time *= kSooner;
    if (scene.wind.air) scene.wind.air->max_particles = 4000;
    scene.detached.remove_after = 1;
    return scene;
  }

 private:
  ScratchFolder folder_;
  std::vector<std::string> names_;
};

const ShippedScenes& shipped() {
  static const ShippedScenes scenes;
  return scenes;
}

/// What a run was like: its hash after every step, and its state at some.
struct Course {
  std::vector<uint64_t> hashes;
  std::map<size_t, WorldState> states;
  WorldReport report;
};

Course straight_run(World& world, size_t steps, const std::vector<size_t>& keep) {
  Course run;
  for (size_t i = 0;; ++i) {
    if (std::find(keep.begin(), keep.end(), i) != keep.end() || i == steps) world.save(run.states[i]);
    run.hashes.push_back(world.state_hash());
    if (i == steps) break;
    world.step();
  }
  run.report = world.report();
  return run;
}

/// Goes on from a state of the run, for so many steps or to its end, and compares.
void expect_same_from(World& world, const Course& run, size_t from, size_t steps) {
  world.load(WorldState(run.states.at(from).bytes()));
  EXPECT_EQ(world.save(), run.states.at(from)) << "what is loaded is what was saved";
  const size_t end = std::min(from + steps, run.hashes.size() - 1);
  ASSERT_EQ(world.state_hash(), run.hashes[from]);
  for (size_t i = from + 1; i <= end; ++i) {
    world.step();
    ASSERT_EQ(world.state_hash(), run.hashes[i]) << "step " << i << ", loaded at " << from;
  }
  if (const auto known = run.states.find(end); known != run.states.end()) {
    EXPECT_EQ(world.save(), known->second) << "also what the hash of the motion does not see";
  }
}

class SavedWorld : public ::testing::TestWithParam<std::string> {};

TEST_P(SavedWorld, GoesOnAsIfNothingHadHappened) {
  const Scene scene = shipped().hurried(GetParam());
  const auto steps = static_cast<size_t>(scene.seconds / scene.time_step);
  Random random(steps, "tests/world_state");
  std::vector<size_t> saved;
  for (int i = 0; i < 3; ++i) saved.push_back(1 + random.next() % (steps - 1));
  std::sort(saved.begin(), saved.end());
  World world(scene, 2);
  const Course run = straight_run(world, steps, saved);
  EXPECT_GT(run.report.particles, 100u);
  {
    SCOPED_TRACE("back to where it was, as when something is undone");
    expect_same_from(world, run, saved[0], 40);
  }
  for (const unsigned threads : {1u, 2u}) {
    SCOPED_TRACE(threads);
    World other(scene, threads);
    expect_same_from(other, run, saved[threads], steps);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, SavedWorld, ::testing::ValuesIn(shipped().names()),
                         [](const auto& name) { return name.param; });

TEST(SavedWorld, OfAllScenesSomeGrowBreakCutGrabMoveAndBlow) {
  size_t anchors = 0, broken = 0, cut = 0, touching = 0, emitted = 0;
  for (const std::string name : {"break", "grow_grab_cut", "moving_cubes", "sph_wind"}) {
    World world(shipped().hurried(name), 2);
    const auto steps = static_cast<size_t>(world.scene().seconds / world.time_step());
    for (size_t i = 0; i < steps; ++i) world.step(), touching += world.report().plant_contacts;
    const WorldReport report = world.report();
    anchors += report.anchors, broken += report.broken + report.shed, cut += report.cut;
    if (report.air) emitted += report.air->emitted;
  }
  EXPECT_GT(anchors, 50u);
  EXPECT_GT(broken, 0u);
  EXPECT_GT(cut, 0u);
  EXPECT_GT(touching, 100u);
  EXPECT_GT(emitted, 500u);
}

/// Everything at once in a small scene: growth, breaking, touching plants, air, and a user who holds on and
/// cuts.
class SavedBusyWorld : public ::testing::Test {
 protected:
  SavedBusyWorld() : scene_(test::busy_scene(folder_)) {
    scene_.wind.velocity = {25, 0, -8};
    scene_.plant_contacts = true;
    scene_.plants[1].position = {-0.8, 0, 0.6};
    scene_.impulses = {{0, "#0", 1.2, {2, 0, 1}}};
    scene_.grabs = {
        {{.climber = false, .index = 0, .domain = "#1", .along = 0.7}, 0.3, 2, {{0.3, 0.2, 0}}, 1}};
  }
  /// As a user would who holds a twig and cuts another at a step.
  static void act(World& world, size_t step) {
    const WorldSpring hold{.particle = ParticleId(3),
                           .target = {-0.7, 1, 0.6},
                           .stiffness = 100 * Mat3::Identity(),
                           .damping = 5 * Mat3::Identity()};
    if (step >= 5 && step < 30) world.set_grab(1, hold);
    if (step == 30) world.clear_grab();
    if (step == 10) world.cut(1, world.plant(1).branches[1].particles[1]);
  }
  /// One world goes straight on and is saved before every step; another takes each step from what was saved.
  WorldReport goes_on_from_every_step(size_t steps) const {
    std::vector<WorldState> states(steps + 1);
    World world(scene_, 2), other(scene_, 1);
    for (size_t i = 0; i <= steps; ++i) {
      world.save(states[i]);
      act(world, i);
      world.step();
    }
    for (size_t i = 0; i < steps; ++i) {
      other.load(states[i]);
      act(other, i);
      other.step();
      EXPECT_EQ(other.save(), states[i + 1]) << "step " << i;
      if (HasFailure()) break;
    }
    EXPECT_EQ(world.report().cut, 1u);
    return world.report();
  }

  ScratchFolder folder_;
  Scene scene_;
};

TEST_F(SavedBusyWorld, GoesOnFromEveryStep) {
  const WorldReport report = goes_on_from_every_step(60);
  EXPECT_GT(report.broken + report.shed, 0u);
}

TEST_F(SavedBusyWorld, GoesOnFromEveryStepOfTheOtherSolver) {
  scene_.solver = Solver::ShapeMatching;
  scene_.wind.air.reset();
  scene_.wind.velocity = {3, 0, -1};
  for (ScenePlant& plant : scene_.plants) plant.breaking = 0;
  goes_on_from_every_step(40);
}

TEST_F(SavedBusyWorld, IsTheSameStateWithTheSameHashOrAnother) {
  World one(scene_, 2), two(scene_, 1);
  for (int i = 0; i < 10; ++i) one.step(), two.step();
  EXPECT_EQ(one.save(), two.save());
  EXPECT_EQ(one.save().hash(), two.save().hash());
  two.step();
  EXPECT_NE(one.save().hash(), two.save().hash());
  two.load(one.save());
  EXPECT_EQ(two.stats().steps, 10u);
  EXPECT_EQ(one.save(), two.save());
}

TEST_F(SavedBusyWorld, OfAnotherSceneIsRefusedAndChangesNothing) {
  World world(scene_, 1);
  world.step();
  const WorldState state = world.save();
  const auto refused = [&](const Scene& scene) {
    World other(scene, 1);
    const WorldState before = other.save();
    EXPECT_THROW(other.load(state), Error);
    EXPECT_EQ(other.save(), before);
  };
  Scene other = scene_;
  other.plants[0].yaw += 1e-9;
  refused(other);
  other = scene_;
  other.obstacles[0].mesh.positions[0].x() -= 1e-9;
  refused(with_separate_solids(other));
  other = scene_;
  other.wind.air->emitters[0].speed = 7;
  refused(other);
  other = scene_;
  other.camera = SceneCamera{{0, 1, 5}, {0, 1, 0}, 0.7};
  World same(other, 1);
  EXPECT_NO_THROW(same.load(state)) << "how it is looked at is no matter";
}

TEST_F(SavedBusyWorld, DamagedOrCutBytesAreAnError) {
  World world(scene_, 1);
  for (int i = 0; i < 5; ++i) world.step();
  const WorldState state = world.save();
  Random random(2, "tests/world_state/damage");
  StateBytes bytes(state.bytes());
  for (int i = 0; i < 10000; ++i) {
    const size_t at = i < 500 ? static_cast<size_t>(i) % 60 : random.next() % bytes.size();
    const auto flip = static_cast<std::byte>(1u << random.next() % 8);
    bytes.data()[at] ^= flip;
    EXPECT_THROW(WorldState{bytes.view()}, Error) << at;
    bytes.data()[at] ^= flip;
  }
  for (int i = 0; i < 300; ++i) {
    const size_t size = i < 60 ? static_cast<size_t>(i) : random.next() % bytes.size();
    EXPECT_THROW(WorldState{bytes.view().first(size)}, Error) << size;
  }
  EXPECT_EQ(WorldState(bytes.view()), state);
}

TEST(WorldOfAScene, NeedsItsSolidsMadeByAnExplicitChoice) {
  const ScratchFolder folder;
  Scene scene = test::busy_scene(folder);
  scene.solids.reset();
  EXPECT_THROW(World(scene, 1), Error);
  EXPECT_NO_THROW(World(with_separate_solids(scene), 1));
}

}  // namespace
}  // namespace liana
