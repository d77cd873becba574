#include "runtime/picture/plant_drawing.h"

#include <gtest/gtest.h>

#include "runtime/picture/leaf_mesh.h"
#include "tests/support/plants/draw_plants.h"

namespace liana {
namespace {

DrawScene drawn(const Plant& plant, const PlantDrawingOptions& options = {}) {
  DrawScene scene;
  add_plant(plant, plant_look("ivy"), options, scene);
  return scene;
}

TEST(PlantDrawing, OneTubePerBranchAndOneBladePerLeaf) {
  const DrawScene scene = drawn(support::forked_plant(), {.names = true});
  ASSERT_EQ(scene.tubes.size(), 2u);
  ASSERT_EQ(scene.leaves.size(), 1u);
  EXPECT_EQ(scene.tubes[1].name, "forked branch 1");
  EXPECT_EQ(scene.leaves[0].name, "forked leaf 2");
}

TEST(PlantDrawing, StraightStemKeepsItsLineItsRadiusAndItsTip) {
  const DrawTube tube = drawn(support::forked_plant()).tubes[0];
  for (size_t i = 0; i < tube.points.size(); ++i) {
    EXPECT_NEAR(tube.points[i].x(), 0, 1e-12);
    EXPECT_NEAR(tube.points[i].z(), 0, 1e-12);
    if (tube.points[i].y() > 0) {
      EXPECT_NEAR(tube.radii[i], 0.01, 1e-12);
    }
  }
  EXPECT_NEAR(tube.points.back().y(), 1, 1e-12);
  EXPECT_LT(tube.points.front().y(), 0);  // reaches into the ground
}

TEST(PlantDrawing, SideBranchStartsOnItsParentsCentreline) {
  const DrawTube tube = drawn(support::forked_plant()).tubes[1];
  // Particle 4's centre is at 0.45 m; the joint sits 2 cm above it.
  EXPECT_LT((tube.points.front() - Vec3(0, 0.47, 0)).norm(), 1e-12);
  EXPECT_LE(tube.radii.front(), 0.01);
}

TEST(PlantDrawing, CurveThroughABentChainIsSmooth) {
  Plant plant;
  support::add_chain(plant, {}, Vec3::Zero(), Vec3::UnitY(), 8, 0.05, 0.01);
  // Bend it into an arc of 8 x 0.2 rad.
  Vec3 tail = Vec3::Zero();
  for (int i = 0; i < 8; ++i) {
    plant.motion[i].orientation = Quat(Eigen::AngleAxisd(0.2 * i, Vec3::UnitZ()));
    plant.motion[i].position = tail + plant.motion[i].orientation * Vec3(0, 0.05, 0);
    tail += plant.motion[i].orientation * Vec3(0, 0.1, 0);
  }
  const DrawTube tube = drawn(plant, {.points_per_particle = 4}).tubes[0];
  for (size_t i = 2; i < tube.points.size(); ++i) {
    const Vec3 a = (tube.points[i - 1] - tube.points[i - 2]).normalized(),
               b = (tube.points[i] - tube.points[i - 1]).normalized();
    // Evenly spread, a step would turn by 0.05 rad; straight pieces would show 0.2 at the joints.
    EXPECT_LT(std::acos(std::min(1.0, a.dot(b))), 0.1);
  }
  EXPECT_NEAR((tube.points.back() - tail).norm(), 0, 1e-12);
}

TEST(PlantDrawing, BladeLiesAlongItsParticle) {
  const Plant plant = support::forked_plant();
  const DrawLeaf leaf = drawn(plant).leaves[0];
  EXPECT_NEAR(leaf.length, 0.08, 1e-12);
  EXPECT_NEAR(leaf.width, 0.06, 1e-12);
  const Vec3 tip = leaf.orientation * blade_point(leaf, {0, 1});
  const Vec3 axis = plant.motion.back().orientation * Vec3::UnitY();
  EXPECT_NEAR(tip.normalized().dot(axis), 1, 1e-12);
}

TEST(PlantDrawing, ShadesStayWhenThePlantGrows) {
  Plant plant = support::forked_plant();
  const DrawScene before = drawn(plant);
  support::add_chain(plant, ParticleId(8), {0, 0, 0}, Vec3(1, 0, 0.2).normalized(), 3, 0.03, 0.004);
  const DrawScene after = drawn(plant);
  EXPECT_EQ(before.tubes[0].color, after.tubes[0].color);
  EXPECT_EQ(before.leaves[0].color, after.leaves[0].color);
}

TEST(PlantDrawing, BudWithoutParticlesDrawsNothing) {
  Plant plant = support::forked_plant();
  plant.branches.emplace_back();
  EXPECT_EQ(drawn(plant).tubes.size(), 2u);
}

}  // namespace
}  // namespace liana
