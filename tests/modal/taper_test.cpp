// Materials that vary along a domain ([Wang17] Eq. 11), against a beam solved in one dimension.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "mesher/tets/tetrahedralize.h"
#include "modal/domains/domain_modes.h"
#include "modal/elements/taper_field.h"
#include "tests/support/closed_forms.h"

namespace liana {
namespace {

/// Lowest frequency (Hz) of an Euler-Bernoulli cantilever with E(x) = s E, ρ(x) = s ρ: 200 cubic elements.
double beam_frequency(int sides, double length, double diameter, const std::function<double(double)>& s) {
  const ElasticMaterial m;
  constexpr int kElements = 200;
  const double h = length / kElements;
  const double EI = m.youngs_modulus * polygon_second_moment(sides, diameter);
  const double rhoA = m.density * polygon_area(sides, diameter);
  Eigen::Matrix4d k, c;
  k << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h,
      -6 * h, 4 * h * h;
  c << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h, 54, 13 * h, 156, -22 * h, -13 * h,
      -3 * h * h, -22 * h, 4 * h * h;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * kElements + 2, 2 * kElements + 2), M = K;
  for (int e = 0; e < kElements; ++e) {
    const double factor = s((e + 0.5) * h);
    K.block<4, 4>(2 * e, 2 * e) += factor * EI / (h * h * h) * k;
    M.block<4, 4>(2 * e, 2 * e) += factor * rhoA * h / 420 * c;
  }
  const int n = 2 * kElements;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      K.bottomRightCorner(n, n), M.bottomRightCorner(n, n), Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[0]) / (2 * kPi);
}

MarkedMesh branch(double length, double diameter, int rings) {
  std::vector<double> stations;
  for (int i = 0; i <= rings; ++i) stations.push_back(length * i / rings);
  return make_tube({.sides = 8, .length = length, .diameter = diameter, .stations = stations});
}

// The tets' own steps in s and T10's error on this mesh are each below 0.5 %.
TEST(Taper, FrequencyIsThatOfABeamWhoseMaterialVaries) {
  const double length = 1, diameter = 0.03, longest = length + diameter / 2;  // to the middle of the tip
  const MarkedMesh mesh = branch(length, diameter, 32);
  for (const TaperLaw& law : {TaperLaw{1, 0.2, 2}, TaperLaw{1, 0.05, 1}, TaperLaw{0.5, 2, 3}}) {
    Solid solid{&mesh.mesh, mesh.is_root, {}, law};
    Progress silent;
    const AllModes all = solve_domains({solid}, {}, {}, silent);
    const double expected =
        beam_frequency(8, length, diameter, [&](double x) { return taper_scaling(law, x / longest); });
    EXPECT_NEAR(all.domains[0].frequencies[0] / expected, 1, 0.01)
        << law.root_scaling << " to " << law.tip_scaling;
  }
}

TEST(Taper, EqualFactorsEverywhereAreAUniformMaterial) {
  const MarkedMesh mesh = branch(1, 0.05, 8);
  const TetMesh tets = tetrahedralize(mesh.mesh, mesh.is_root);
  const std::vector<ElementScaling> scaling = tapered(tets, {.root_scaling = 4, .tip_scaling = 4});
  const Modes uniform = lowest_modes(tets, {}, {}), scaled = lowest_modes(tets, {}, {}, {}, scaling);
  EXPECT_NEAR(scaled.frequencies[0], uniform.frequencies[0], 1e-9 * uniform.frequencies[0]);
  const ElasticMaterial stiffer{.youngs_modulus = 4 * ElasticMaterial().youngs_modulus};
  for (ElementScaling s : {ElementScaling{4, 1}}) {
    const std::vector<ElementScaling> stiffness(tets.tets.size(), s);
    EXPECT_NEAR(lowest_modes(tets, {}, {}, {}, stiffness).frequencies[0],
                lowest_modes(tets, stiffer, {}).frequencies[0], 1e-9 * uniform.frequencies[0]);
  }
}

TEST(Taper, FactorsFallFromTheRootByGeodesicDistance) {
  const MarkedMesh mesh = branch(1, 0.05, 16);
  const TetMesh tets = tetrahedralize(mesh.mesh, mesh.is_root);
  const std::vector<ElementScaling> scaling =
      tapered(tets, {.root_scaling = 1, .tip_scaling = 0, .epsilon3 = 1});
  for (size_t e = 0; e < tets.tets.size(); ++e) {
    double y = 0;
    for (const uint32_t v : tets.tets[e]) y += tets.positions[v].y() / 4;
    // s = 1 − ℓ_i/ℓ; the caps' centres lie up to a radius farther along the surface than along the axis.
    EXPECT_NEAR(scaling[e].stiffness, 1 - y / 1.025, 0.03) << "tet " << e;
    EXPECT_EQ(scaling[e].stiffness, scaling[e].density);
  }
}

TEST(Taper, CopiesOfAShapeWithAnotherTaperAreSolvedOnTheirOwn) {
  const MarkedMesh mesh = branch(1, 0.05, 8);
  const Solid plain{&mesh.mesh, mesh.is_root, {}}, soft{&mesh.mesh, mesh.is_root, {}, {1, 0.2, 2}};
  Progress silent;
  const AllModes all = solve_domains({plain, soft, soft}, {}, {}, silent);
  EXPECT_EQ(all.domains[1].solved_as, 1u);
  EXPECT_EQ(all.domains[2].solved_as, 1u);
  EXPECT_GT(std::abs(all.domains[1].frequencies[0] / all.domains[0].frequencies[0] - 1), 0.05);
}

}  // namespace
}  // namespace liana
