#include "modal/domains/domain_modes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>

#include "tests/support/closed_forms.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

/// Solids with their meshes; a deque keeps references in place.
struct Plant {
  std::deque<MarkedMesh> meshes;
  std::vector<Solid> solids;

  Solid& add(MarkedMesh mesh, std::vector<CarriedMass> carried = {}) {
    meshes.push_back(std::move(mesh));
    solids.push_back({&meshes.back().mesh, meshes.back().is_root, std::move(carried)});
    return solids.back();
  }
  AllModes solve(DomainModesOptions options = {}) const {
    Progress silent;
    return solve_domains(solids, {}, options, silent);
  }
};

MarkedMesh moved(MarkedMesh mesh, const Affine3& transform) {
  mesh.mesh = transformed(mesh.mesh, transform);
  return mesh;
}

Affine3 some_motion(double scale) {
  return Eigen::Translation3d(5, -2, 1) * Eigen::AngleAxisd(2.2, Vec3(1, -1, 3).normalized()) *
         Eigen::Scaling(scale);
}

const MarkedMesh kBranch =
    make_tube({.sides = 6, .length = 0.4, .diameter = 0.02, .tip_scale = 0.6, .bend = 0.4, .stations = {}});

TEST(DomainModes, RotatedAndScaledCopiesAreSolvedOnce) {
  const std::vector<CarriedMass> carried = {{Vec3(0.02, 0.2, 0), 0.01}, {Vec3(0.05, 0.35, 0), 0.002}};
  Plant plant;
  plant.add(kBranch, carried);
  const double s = 0.37;
  std::vector<CarriedMass> copied;
  for (const CarriedMass& c : carried) copied.push_back({some_motion(s) * c.position, c.mass * s * s * s});
  std::swap(copied[0], copied[1]);  // their order says nothing
  plant.add(moved(kBranch, some_motion(s)), copied);

  const AllModes shared = plant.solve();
  const AllModes each = plant.solve({.modes = {}, .tets = {}, .share_equal_shapes = false});
  EXPECT_EQ(shared.domains[1].solved_as, 0u);
  EXPECT_EQ(each.domains[1].solved_as, 1u);
  for (int mode = 0; mode < 2; ++mode) {
    const DomainModes &a = shared.domains[1], &b = each.domains[1];
    // The tets differ by rounding in TetGen's decisions: as much as two meshes of a shape do.
    EXPECT_NEAR(a.frequencies[mode] / b.frequencies[mode], 1, 1e-3);
    EXPECT_NEAR(a.sway.frequencies[mode] / b.sway.frequencies[mode], 1, 1e-3);
    EXPECT_GT(std::abs(a.sway.directions[mode].dot(b.sway.directions[mode])), 0.999);
  }
}

TEST(DomainModes, NearCopiesAreSolvedThemselves) {
  const std::vector<CarriedMass> carried = {{Vec3(0, 0.4, 0), 0.01}};
  Plant plant;
  plant.add(kBranch, carried);
  MarkedMesh bulged = kBranch;
  bulged.mesh.positions[20] += Vec3(1e-4, 0, 0);  // 1 % of the thickness
  plant.add(bulged, carried);
  plant.add(moved(kBranch, Affine3(Eigen::Scaling(1., 1.01, 1.))), carried);
  plant.add(kBranch, {{Vec3(0, 0.4, 0), 0.0101}});
  plant.add(kBranch, {{Vec3(0, 0.39, 0), 0.01}});
  plant.add(kBranch);
  MarkedMesh held_elsewhere = kBranch;
  held_elsewhere.is_root[0] = 1;
  plant.add(held_elsewhere, carried);
  plant.add(moved(kBranch, Affine3(Eigen::Scaling(0.5))), carried);  // smaller, with the same mass to carry
  plant.add(moved(kBranch, Affine3(Eigen::Scaling(1., 1., -1.))),
            {{Vec3(0, 0.4, 0), 0.01}});  // winds the other way
  const AllModes modes = plant.solve();
  for (size_t i = 0; i < plant.solids.size(); ++i) EXPECT_EQ(modes.domains[i].solved_as, i) << i;
}

TEST(DomainModes, OneBadSolidLeavesTheOthers) {
  Plant plant;
  plant.add(kBranch);
  MarkedMesh open = kBranch;
  open.mesh.triangles.pop_back();
  open.is_root.pop_back();
  plant.add(open);
  MarkedMesh unheld = kBranch;
  unheld.is_root.assign(unheld.is_root.size(), 0);
  plant.add(unheld);
  MarkedMesh broken = kBranch;
  broken.mesh.positions[3].x() = std::nan("");
  plant.add(broken);
  plant.add(open);
  const AllModes modes = plant.solve();
  EXPECT_TRUE(modes.domains[0].failure.empty());
  EXPECT_TRUE(modes.domains[0].converged);
  for (size_t i = 1; i < 5; ++i) {
    EXPECT_FALSE(modes.domains[i].failure.empty()) << i;
    EXPECT_TRUE(modes.domains[i].frequencies.empty()) << i;
  }
  EXPECT_NE(modes.domains[1].failure.find("open"), std::string::npos);
  EXPECT_NE(modes.domains[2].failure.find("root"), std::string::npos);
}

TEST(DomainModes, DoNotDependOnTheNumberOfThreads) {
  Plant plant;
  for (int i = 0; i < 24; ++i)
    plant.add(make_tube({.sides = 5 + i % 4,
                         .length = 0.3 + 0.01 * i,
                         .diameter = 0.02,
                         .tip_scale = 0.7,
                         .bend = 0.02 * i,
                         .stations = {}}));
  const AllModes one = plant.solve({.modes = {}, .tets = {}, .threads = 1});
  const AllModes four = plant.solve({.modes = {}, .tets = {}, .threads = 4});
  for (size_t i = 0; i < plant.solids.size(); ++i) {
    EXPECT_EQ(one.domains[i].tets, four.domains[i].tets);
    EXPECT_EQ(one.domains[i].frequencies, four.domains[i].frequencies);
  }
}

TEST(DomainModes, ReportProgressAndStopWhenCancelled) {
  struct Counter : Progress {
    size_t total = 0;
    std::atomic<size_t> done{0};
    size_t stop_after = 1000;
    void begin(std::string_view, size_t n) override { total = n; }
    void advance(size_t n) override { done += n; }
    bool cancelled() const override { return done >= stop_after; }
  };
  Plant plant;
  for (int i = 0; i < 8; ++i) plant.add(make_prism(6, 0.3 + 0.1 * i, 0.02));
  Counter all;
  solve_domains(plant.solids, {}, {}, all);
  EXPECT_EQ(all.total, 8u);
  EXPECT_EQ(all.done, 8u);
  Counter some;
  some.stop_after = 3;
  EXPECT_THROW(
      {
        try {
          solve_domains(plant.solids, {}, {.modes = {}, .tets = {}, .threads = 1}, some);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind, Error::Kind::Cancelled);
          throw;
        }
      },
      Error);
  EXPECT_EQ(some.done, 3u);
}

}  // namespace
}  // namespace liana
