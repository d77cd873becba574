#include "modal/lowest_mode.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/tets/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace liana {
namespace {

TetMesh prism_tets(int sides, double length, double diameter) {
  const MarkedMesh prism = make_prism(sides, length, diameter);
  return tetrahedralize(prism.mesh, prism.is_root);
}

/// Hz; f = 1.87510²/(2π ℓ²) √(E I / (ρ A)) of the polygon's own I and A.
double euler_bernoulli(int sides, double length, double diameter, const ElasticMaterial& m = {}) {
  return 3.5160152685 / (2 * kPi * length * length) *
         std::sqrt(m.youngs_modulus * polygon_second_moment(sides, diameter) /
                   (m.density * polygon_area(sides, diameter)));
}

TEST(LowestMode, MatchesClosedFormOfCantilever) {
  for (const int sides : {6, 8, 12, 24})
    for (const double aspect : {10., 20., 50., 100.}) {
      const double length = 0.5, diameter = length / aspect;
      const TetMesh tets = prism_tets(sides, length, diameter);
      const Modes modes = lowest_modes(tets, {}, {});
      const double expected = euler_bernoulli(sides, length, diameter);
      EXPECT_TRUE(modes.converged);
      printf("sides %d aspect %g tets %zu dof %u it %d res %.1e  err %.3f %% %.3f %%  sway %.3f %% %.3f %%\n",
             sides, aspect, tets.tets.size(), modes.dof, modes.iterations, modes.residual,
             100 * (modes.frequencies[0] / expected - 1), 100 * (modes.frequencies[1] / expected - 1),
             100 * (modes.sway.frequencies[0] / expected - 1),
             100 * (modes.sway.frequencies[1] / expected - 1));
      EXPECT_NEAR(modes.frequencies[0], expected, 0.01 * expected);
    }
}

}  // namespace
}  // namespace liana
