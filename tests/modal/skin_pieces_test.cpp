// A branch cut from a welded skin swings like the branch alone.
#include <gtest/gtest.h>

#include "mesher/solids/skins/skin_cut.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "modal/domains/domain_modes.h"
#include "tests/support/closed_forms.h"
#include "tests/support/solids/skins.h"

namespace liana {
namespace {

TEST(SkinPieces, SwingLikeTheBranchesTheyWere) {
  constexpr double kTrunk = 0.05, kBranch = 0.025, kReach = 0.6;
  const Mesh skin = make_skin({{Vec3(0, 0, 0), Vec3(0, 0.6, 0), kTrunk, kTrunk},
                               {Vec3(0, 0.3, 0), Vec3(kReach, 0.3, 0), kBranch, kBranch}},
                              0.01);
  const std::vector<SkinPiece> pieces = cut_skin(skin);
  ASSERT_EQ(pieces.size(), 2u);
  SegmentedPlant plant;
  for (const SkinPiece& piece : pieces)
    plant.domains.push_back({.name = "piece",
                             .parent = piece.parent < 0 ? DomainId() : DomainId(size_t(piece.parent)),
                             .group = "g",
                             .surface = piece.surface});
  const SolidDomain branch = make_solid(plant, DomainId(1));
  EXPECT_LT((branch.root - Vec3(kTrunk, 0.3, 0)).norm(), 0.6 * kBranch) << "held where it leaves the trunk";
  Progress silent;
  const AllModes all = solve_domains(
      {{&branch.surface, branch.is_root, {}, {}, branch.centreline, branch.volume, branch.is_beam}}, {},
      {.modes = {}, .tets = {}, .threads = 1}, silent);
  ASSERT_EQ(all.domains[0].failure, "");
  // The cut lies up to a tenth of the diameter beyond the bark (2 % in frequency); marching chords thin the
  // branch by about (cell / radius)² / 6 = 2.7 %.
  const double alone = cantilever_frequency(64, kReach - kTrunk, 2 * kBranch);
  EXPECT_NEAR(all.domains[0].frequencies[0] / alone, 1, 0.05) << branch.route << all.domains[0].note;
}

}  // namespace
}  // namespace liana
