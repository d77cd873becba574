#include <gtest/gtest.h>

#include <fstream>

#include "materials/bake/bake_file.h"
#include "mesher/base/error.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/world/scene/scene_file.h"
#include "runtime/world/world_drawing.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/climber_scene.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

class BreakingWorld : public ::testing::Test {
 protected:
  BreakingWorld() {
    Bake bake = test::synthetic_bake({.branches = 6, .twigs = 2, .leaves = 3, .height = 2});
    bake.law = ivy_like_law();
    for (auto& [name, group] : bake.law.groups) group.modulus_of_rupture = name == "leaf" ? 1.5e7 : 4e6;
    for (BakedDomain& domain : bake.domains) domain.default_frequency = domain.material.frequency;
    write_bake(bake, folder_ / "tree.bake");
    for (const BakedDomain& domain : bake.domains) names_.push_back(domain.name);
    scene_.file = folder_ / "scene.toml";
  }
  ScenePlant tree(double breaking) const { return {folder_ / "tree.bake", Vec3::Zero(), 0, breaking}; }
  static void run(World& world, double seconds) {
    for (int i = 0; i < std::lround(seconds / world.time_step()); ++i) world.step();
  }
  static bool finite(const World& world) {
    for (size_t p = 0; p < world.plant_count(); ++p)
      for (const Motion& m : world.plant(p).motion)
        if (!m.position.allFinite() || !m.velocity.allFinite()) return false;
    return true;
  }
  static double highest(const Plant& plant) {
    double top = 0;
    for (const Motion& m : plant.motion) top = std::max(top, m.position.y());
    return top;
  }

  ScratchFolder folder_;
  Scene scene_;
  std::vector<std::string> names_;
};

TEST_F(BreakingWorld, CutPartFallsLiesStillAndIsTakenAway) {
  scene_.plants = {tree(0)};
  scene_.detached.remove_after = 2;
  World world(scene_, 1);
  const size_t particles = world.report().particles, tubes = drawing_of(world, true).tubes.size();
  const ParticleId at = world.plant(0).branches[1].particles[1];
  world.cut(0, at);
  ASSERT_EQ(world.plant_count(), 2u);
  EXPECT_EQ(world.report().cut, 1u);
  EXPECT_EQ(world.report().particles, particles);
  EXPECT_GE(drawing_of(world, true).tubes.size(), tubes) << "the part is drawn as well";
  run(world, 0.5);
  for (int i = 0; i < 400 && world.report().asleep == 0; ++i) world.step();
  EXPECT_EQ(world.report().asleep, 1u) << "it rests within 10 s";
  EXPECT_LT(highest(world.plant(1)), 0.6);
  run(world, 2.1);
  EXPECT_EQ(world.plant_count(), 1u);
  EXPECT_EQ(world.report().removed, 1u);
}

TEST_F(BreakingWorld, StormBreaksHundredsStaysFiniteAndThreadsAgree) {
  for (double x : {-2.0, 2.0}) {
    scene_.plants.push_back(tree(1));
    scene_.plants.back().position = {x, 0, 0};
  }
  scene_.wind.velocity = {60, 0, 0};
  uint64_t hash = 0;
  for (const unsigned threads : {1u, 2u}) {
    World world(scene_, threads);
    run(world, 3);
    const WorldReport report = world.report();
    EXPECT_GT(report.broken + report.shed, 50u);
    EXPECT_EQ(report.lost_steps, 0u);
    EXPECT_TRUE(finite(world));
    if (threads == 1) hash = world.state_hash();
    EXPECT_EQ(world.state_hash(), hash);
  }
  for (ScenePlant& plant : scene_.plants) plant.breaking = 0;
  World whole(scene_, 2);
  run(whole, 1);
  EXPECT_EQ(whole.report().broken + whole.report().shed, 0u) << "0 disables";
  EXPECT_EQ(whole.plant_count(), 2u);
}

TEST_F(BreakingWorld, GrabbedBranchBreaksAndStaysInTheHand) {
  scene_.plants = {tree(1)};
  SceneGrab grab;
  grab.where = {.climber = false, .index = 0, .domain = names_[1], .along = 0.7};
  grab.time = 0.1, grab.seconds = 2, grab.strength = 1;
  grab.path = {{0.8, 0.3, 0}};
  scene_.grabs = {grab};
  World world(scene_, 1);
  const Branch& branch = world.plant(0).branches[1];
  const Vec3 from =
      world.plant(0).motion[branch.particles[branch.particles.size() * 7 / 10].index()].position;
  run(world, 2.05);
  ASSERT_GT(world.report().broken, 0u);
  double nearest = 10;
  size_t held = 0;
  for (size_t p = 1; p < world.plant_count(); ++p)
    for (const Motion& m : world.plant(p).motion) {
      const double distance = (m.position - from - grab.path[0]).norm();
      if (distance < nearest) nearest = distance, held = p;
    }
  EXPECT_LT(nearest, 0.15) << "m from the hand";
  run(world, 6);
  EXPECT_TRUE(finite(world));
  EXPECT_LT(highest(world.plant(held)), 0.7) << "it was let go";
}

TEST_F(BreakingWorld, EditorsGrabFollowsThePartThatBreaksOff) {
  scene_.plants = {tree(0)};
  World world(scene_, 1);
  const ParticleId held = world.plant(0).branches[1].particles.back();
  const Vec3 hand = world.plant(0).motion[held.index()].position;
  WorldSpring spring{.particle = held,
                     .target = hand,
                     .stiffness = 500 * Mat3::Identity(),
                     .damping = 25 * Mat3::Identity()};
  world.set_grab(0, spring);
  run(world, 0.1);
  world.cut(0, world.plant(0).branches[1].particles[1]);
  for (int i = 0; i < 80; ++i) {
    world.set_grab(0, spring);  // as a window does whenever the mouse moves
    world.step();
  }
  double nearest = 10;
  for (const Motion& m : world.plant(1).motion) nearest = std::min(nearest, (m.position - hand).norm());
  EXPECT_LT(nearest, 0.1);
  world.clear_grab();
  run(world, 3);
  EXPECT_LT(highest(world.plant(1)), 0.6);
}

TEST_F(BreakingWorld, ClimberIsCutByTheSceneAndGrowsOn) {
  scene_.climbers = {{folder_ / "tree.bake", "", {0, 0, 0.1}, 1, 600, 0, 1, 1, 3, 0.35}};
  SceneObstacle wall;
  wall.name = "wall";
  wall.mesh = box_mesh({-2, 0, -0.2}, {2, 3, 0});
  scene_.obstacles = {wall};
  scene_.cuts = {{{.climber = true, .index = 0, .domain = "", .along = 0, .at = {0, 0.4, 0}}, 9}};
  World world(with_united_solids(scene_), 2);
  run(world, 9.1);
  EXPECT_EQ(world.report().cut, 1u);
  ASSERT_EQ(world.plant_count(), 2u);
  const size_t after = world.plant(0).particles.size();
  run(world, 5);
  EXPECT_GT(world.plant(0).particles.size(), after);
  EXPECT_TRUE(finite(world));
  EXPECT_TRUE(world.plant(1).anchors.empty()) << "dead roots let go";
}

TEST_F(BreakingWorld, SceneFileIsReadStrictly) {
  const auto read = [&](const std::string& text) {
    std::ofstream(folder_ / "scene.toml") << "[[plant]]\nbake = \"tree.bake\"\nbreaking = 0.5\n" << text;
    return read_scene(folder_ / "scene.toml");
  };
  const Scene scene = read("[[cut]]\ndomain = \"" + names_[1] +
                           "\"\nalong = 0.5\ntime = 2\n"
                           "[[grab]]\nat = [0, 1, 0]\ntime = 1\nseconds = 2\npath = [{ by = [1, 0, 0] }]\n"
                           "[detached]\nremove_after = 5\n");
  EXPECT_EQ(scene.plants[0].breaking, 0.5);
  ASSERT_EQ(scene.cuts.size(), 1u);
  EXPECT_EQ(scene.cuts[0].where.along, 0.5);
  ASSERT_EQ(scene.grabs.size(), 1u);
  EXPECT_EQ(scene.grabs[0].path[0], Vec3(1, 0, 0));
  EXPECT_EQ(scene.detached.remove_after, 5);
  EXPECT_THROW(read("[[cut]]\ntime = 1\n"), Error);
  EXPECT_THROW(read("[[cut]]\nclimber = 0\nat = [0, 1, 0]\n"), Error);
  EXPECT_THROW(read("[[grab]]\nat = [0, 1, 0]\nseconds = 1\npath = []\n"), Error);
  EXPECT_THROW(read("[[grab]]\nat = [0, 1, 0]\nseconds = 1\npath = [{ bye = [1, 0, 0] }]\n"), Error);
  EXPECT_THROW(World(read("[[cut]]\ndomain = \"no such branch\"\n"), 1), Error);
}

TEST_F(BreakingWorld, OldNamesInSceneFilesMeanWhatTheyDid) {
  const auto read = [&](bool old) {
    const std::string first = "[[plant]]\nbake = \"tree.bake\"\n",
                      box = "box = { center = [0, 1, 0], size = [1, 1, 1] }\n";
    const std::string act = "domain = \"" + names_[1] + "\"\nvelocity = [1, 0, 0]\n";
    std::ofstream(folder_ / "scene.toml")
        << first << (old ? "[[pluck]]\n" : "[[impulse]]\n") << act << "[[obstacle]]\n"
        << box << (old ? "elasticity = 0.5\n" : "restitution = 0.5\n")
        << (old ? "[fallen]\n" : "[detached]\n") << "roots_hold = 7\n";
    return read_scene(folder_ / "scene.toml");
  };
  for (const bool old : {false, true}) {
    const Scene scene = read(old);
    ASSERT_EQ(scene.impulses.size(), 1u);
    EXPECT_EQ(scene.impulses[0].velocity, Vec3(1, 0, 0));
    EXPECT_EQ(scene.obstacles.at(0).contact_material.restitution, 0.5);
    EXPECT_EQ(scene.detached.roots_hold, 7);
  }
}

TEST_F(BreakingWorld, ObstaclesAreReadFromObjAndPly) {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  std::ofstream obj(folder_ / "box.obj"), ply(folder_ / "box.ply");
  ply << "ply\nformat ascii 1.0\nelement vertex " << box.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << box.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : box.positions) {
    obj << "v " << p.transpose() << "\n";
    ply << p.transpose() << "\n";
  }
  for (const Triangle& t : box.triangles) {
    obj << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    ply << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  }
  obj.close(), ply.close();
  std::ofstream(folder_ / "scene.toml")
      << "[[obstacle]]\nmesh = \"box.obj\"\nscale = [0.5, 0.5, 0.5]\n"
      << "[[obstacle]]\nmesh = \"box.ply\"\n[[plant]]\nbake = \"tree.bake\"\n";
  const Scene scene = read_scene(folder_ / "scene.toml");
  ASSERT_EQ(scene.obstacles.size(), 2u);
  EXPECT_EQ(scene.obstacles[0].mesh.triangles.size(), 12u);
  EXPECT_NEAR(SdfObstacle(scene.obstacles[0].mesh).high().z(), 1.5, 1e-12);
  EXPECT_NEAR(SdfObstacle(scene.obstacles[1].mesh).high().z(), 3, 1e-12);
}

}  // namespace
}  // namespace liana
