// Solids with published or exact frequencies that are not held at one face only.
#include <gtest/gtest.h>

#include "mesher/tets/tetrahedralize.h"
#include "modal/solve/eigenpairs.h"
#include "tests/support/closed_forms.h"
#include "tests/support/solids/block_tets.h"

namespace liana {
namespace {

constexpr double kSquareRootOfTwo = 1.4142135623730951;

struct Problem {
  NodeMesh nodes;
  System system;
  std::vector<uint8_t> held;

  Problem(const TetMesh& mesh, Element element, const ElasticMaterial& material)
      : nodes(make_nodes(mesh, element)),
        system(assemble(nodes, element, material)),
        held(3 * nodes.positions.size(), 0) {}

  template <class Where>
  void hold(int axis, Where where) {
    for (size_t n = 0; n < nodes.positions.size(); ++n)
      if (where(nodes.positions[n])) held[3 * n + axis] = 1;
  }
  std::vector<double> frequencies(const EigenOptions& options) const {
    const EigenResult result = lowest_eigenpairs(system, held, options);
    EXPECT_TRUE(result.converged);
    std::vector<double> hertz;
    for (const double lambda : result.eigenvalues)
      hertz.push_back(std::sqrt(std::max(0., lambda)) / (2 * kPi * system.time));
    return hertz;
  }
};

// NAFEMS "Selected benchmarks for natural frequency analysis", test FV32. T10 was measured within 0.03 %.
TEST(BenchmarkSolids, TaperedMembraneOfNafemsFv32) {
  const TetMesh mesh = make_block(16, 8, 1, [](const Vec3& p) {
    const double height = 5 - 4 * p.x();
    return Vec3(10 * p.x(), height * (p.y() - 0.5), 0.05 * p.z());
  });
  Problem membrane(mesh, Element::T10, {.youngs_modulus = 200e9, .density = 8000, .poisson_ratio = 0.3});
  for (const int axis : {0, 1}) membrane.hold(axis, [](const Vec3& p) { return p.x() == 0; });
  membrane.hold(2, [](const Vec3& p) { return p.z() == 0; });
  const std::vector<double> found = membrane.frequencies({.modes = 6});
  const double expected[] = {44.623, 130.03, 162.70, 246.05, 379.90, 391.44};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(found[i], expected[i], 0.002 * expected[i]) << "mode " << i + 1;
}

// Lamé's mode of the free cube is exact for any Poisson ratio: u = (cos πx sin πy, −sin πx cos πy, 0).
TEST(BenchmarkSolids, LameModeOfFreeCube) {
  for (const double nu : {0., 0.3}) {
    const ElasticMaterial material{.youngs_modulus = 1e9, .density = 1000, .poisson_ratio = nu};
    const double edge = 0.2, G = material.youngs_modulus / (2 * (1 + nu));
    const double expected = std::sqrt(G / material.density) / (kSquareRootOfTwo * edge);
    Problem cube(make_block(6, 6, 6, [&](const Vec3& p) { return Vec3(edge * p); }), Element::T10, material);
    const EigenResult result =
        lowest_eigenpairs(cube.system, cube.held, {.modes = 26, .shift = 1, .tolerance = 1e-4});
    ASSERT_TRUE(result.converged);
    NodalVectors exact(3 * cube.nodes.positions.size(), 1);
    for (size_t n = 0; n < cube.nodes.positions.size(); ++n) {
      const Vec3 p = cube.nodes.positions[n] * (kPi / edge);
      exact.middleRows<3>(3 * n) =
          Vec3(std::cos(p.x()) * std::sin(p.y()), -std::sin(p.x()) * std::cos(p.y()), 0);
    }
    const NodalVectors mass_exact = cube.system.multiply_mass(exact);
    const double size = exact.col(0).dot(mass_exact.col(0));
    double share = 0;  // of the exact mode's kinetic energy in the modes found within 0.2 % of its frequency
    for (Eigen::Index i = 0; i < result.eigenvalues.size(); ++i) {
      const double f = std::sqrt(std::max(0., result.eigenvalues[i])) / (2 * kPi * cube.system.time);
      if (std::abs(f / expected - 1) < 0.002)
        share += std::pow(result.vectors.col(i).dot(mass_exact.col(0)), 2) / size;
    }
    EXPECT_GT(share, 0.999) << "Poisson ratio " << nu;
  }
}

TEST(BenchmarkSolids, FreeCubeHasSixRigidModes) {
  Problem cube(make_block(2, 2, 2, [](const Vec3& p) { return p; }), Element::T10, {});
  const EigenResult result = lowest_eigenpairs(cube.system, cube.held, {.modes = 7, .shift = 1});
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(result.eigenvalues[i], 0, 1e-8);
  EXPECT_GT(result.eigenvalues[6], 1);
}

/// Relative error of the first frequency of a bar with lateral motion held: ω = (π / 2ℓ) √(E/ρ) for ν = 0.
double bar_error(Element element, int cells) {
  const ElasticMaterial material{.youngs_modulus = 2e9, .density = 500, .poisson_ratio = 0};
  Problem bar(make_block(cells, 1, 1, [](const Vec3& p) { return Vec3(p.x(), 0.01 * p.y(), 0.01 * p.z()); }),
              element, material);
  const auto everywhere = [](const Vec3&) { return true; };
  bar.hold(0, [](const Vec3& p) { return p.x() == 0; });
  bar.hold(1, everywhere);
  bar.hold(2, everywhere);
  return bar.frequencies({.modes = 1, .tolerance = 1e-7})[0] / (std::sqrt(2e9 / 500) / 4) - 1;
}

// Eigenvalues of degree-p elements converge with h^(2p), from above. The bar is thin, so that shear
// keeps each section plane; the next power of h adds less than a tenth of an order.
TEST(BenchmarkSolids, BarConvergesWithTheElementsOrder) {
  const double linear = std::log2(bar_error(Element::T4, 8) / bar_error(Element::T4, 16));
  const double quadratic = std::log2(bar_error(Element::T10, 4) / bar_error(Element::T10, 8));
  EXPECT_GT(bar_error(Element::T10, 4), 0);
  EXPECT_NEAR(linear, 2, 0.1);
  EXPECT_NEAR(quadratic, 4, 0.1);
}

// Length 1, diameter 0.05, both ends free. Thin-beam bending overestimates by 0.6 % (shear, rotary inertia).
TEST(BenchmarkSolids, FreeRodBendsAndStretches) {
  const double length = 1, diameter = 0.05;
  const int sides = 12;
  std::vector<double> stations;
  for (int i = 0; i <= 20; ++i) stations.push_back(length * i / 20);
  const MarkedMesh rod =
      make_tube({.sides = sides, .length = length, .diameter = diameter, .stations = stations});
  Problem problem(tetrahedralize(rod.mesh, rod.is_root), Element::T10, {});
  const std::vector<double> found = problem.frequencies({.modes = 16, .shift = 1e-2});
  const double bending = 22.3732854 / 3.5160152685 * cantilever_frequency(sides, length, diameter);
  EXPECT_NEAR(found[6] / bending, 0.994, 0.003);
  EXPECT_NEAR(found[7] / bending, 0.994, 0.003);
  const double axial = std::sqrt(8.77e9 / 745) / (2 * length);  // Poisson's contraction takes 0.01 %
  double nearest = 1;
  for (const double f : found) nearest = std::min(nearest, std::abs(f / axial - 1));
  EXPECT_LT(nearest, 0.002);
}

}  // namespace
}  // namespace liana
