// Modes of a whole plant: particles against closed forms, and against finite elements of the same plant.
#include <gtest/gtest.h>

#include "mesher/tets/tetrahedralize.h"
#include "modal/elements/interpolation.h"
#include "modal/solve/lowest_mode.h"
#include "modal/whole_plant/united_modes.h"
#include "runtime/sim/calibrate/held_chain.h"
#include "runtime/sim/check/particle_modes.h"
#include "tests/support/closed_forms.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

// λ² = 3.51602, 22.0345, each twice for a round rod. 60 particles: O(h²), and rotary inertia and shear of
// aspect 50 take 0.4 % from the second.
TEST(ParticleModes, OfARodAreThoseOfACantilever) {
  const test::RodShape rod{.length = 1, .radius = 0.01};
  const ParticleModes modes = particle_modes(test::rod_plant(rod, 60), 4);
  ASSERT_TRUE(modes.converged);
  const double unit = rod.radius / 2 * std::sqrt(rod.youngs_modulus / rod.density) / (2 * kPi);
  EXPECT_NEAR(modes.frequencies[0] / (3.51602 * unit), 1, 0.005);
  EXPECT_NEAR(modes.frequencies[1] / (3.51602 * unit), 1, 0.005);
  EXPECT_NEAR(modes.frequencies[2] / (22.0345 * unit), 1, 0.01);
  EXPECT_NEAR(modes.frequencies[3] / (22.0345 * unit), 1, 0.01);
}

TEST(ParticleModes, OfOneBranchAreThoseOfTheHeldChain) {
  const Plant plant = test::rod_plant({}, 12);
  HeldChain chain;
  chain.build(plant, BranchId(0), carried_masses(plant));
  EXPECT_NEAR(particle_modes(plant, 1).frequencies[0], std::sqrt(chain.lowest_eigenvalue()) / (2 * kPi),
              1e-6);
}

TEST(ParticleModes, AssuranceTellsShapesApart) {
  const Plant plant = test::rod_plant({}, 10);
  std::vector<Vec3> x(10, Vec3::UnitX()), twice(10, 2 * Vec3::UnitX()), z(10, Vec3::UnitZ());
  EXPECT_DOUBLE_EQ(assurance(plant, x, twice), 1);
  EXPECT_DOUBLE_EQ(assurance(plant, x, z), 0);
}

UnitedPart part_of(const MarkedMesh& marked, const Affine3& place, int parent) {
  return {.mesh = tetrahedralize(transformed(marked.mesh, place), marked.is_root),
          .material = {},
          .scaling = {},
          .parent = parent};
}

// Two halves end to end, the upper one's base tied to the lower one's tip: what the tie's interpolation and
// the second set of graded rings change is below the 1 % of the mesh itself.
TEST(UnitedModes, TwoHalvesOfABeamMoveAsTheWhole) {
  const double length = 1, diameter = 0.05;
  std::vector<double> rings = graded_stations(length / 2, diameter);
  for (const double s : graded_stations(length / 2, diameter))
    if (s > 0) rings.push_back(length / 2 + s);
  const MarkedMesh half = make_prism(8, length / 2, diameter);
  const MarkedMesh whole = make_tube({.sides = 8, .length = length, .diameter = diameter, .stations = rings});
  const Affine3 up(Eigen::Translation3d(0, length / 2, 0));
  const UnitedModes two = united_modes({part_of(half, Affine3::Identity(), -1), part_of(half, up, 0)}, 4);
  const UnitedModes one = united_modes({part_of(whole, Affine3::Identity(), -1)}, 4);
  ASSERT_TRUE(two.converged && one.converged);
  EXPECT_GT(two.tied_nodes, 8u);
  for (int m = 0; m < 4; ++m)
    EXPECT_NEAR(two.frequencies[m] / one.frequencies[m], 1, 0.01) << "mode " << m + 1;
  EXPECT_NEAR(one.frequencies[0] / cantilever_frequency(8, length, diameter), 1, 0.01);
}

// One part goes the way of one domain but for the ties, of which it has none.
TEST(UnitedModes, OfOneDomainAreItsOwn) {
  const MarkedMesh prism = make_prism(6, 0.4, 0.03);
  const TetMesh tets = tetrahedralize(prism.mesh, prism.is_root);
  const UnitedModes united = united_modes({{tets, {}, {}, -1}}, 2);
  EXPECT_NEAR(united.frequencies[0], lowest_modes(tets, {}, {}).frequencies[0], 1e-6 * united.frequencies[0]);
}

// A linear field is in the elements' space, and outside they are continued linearly.
TEST(Interpolation, LinearFieldsAreExactInsideAndOut) {
  const MarkedMesh prism = make_prism(6, 0.4, 0.03);
  const NodeMesh nodes = make_nodes(tetrahedralize(prism.mesh, prism.is_root), Element::T10);
  for (const Vec3& point : {Vec3(0.003, 0.21, 0.002), Vec3(0.05, 0.1, 0), Vec3(0, 0.45, 0)}) {
    Vec3 sum = Vec3::Zero();
    double ones = 0;
    for (const auto& [node, weight] : interpolate_at(nodes, point))
      sum += weight * nodes.positions[node], ones += weight;
    EXPECT_NEAR((sum - point).norm(), 0, 1e-12);
    EXPECT_NEAR(ones, 1, 1e-12);
  }
}

}  // namespace
}  // namespace liana
