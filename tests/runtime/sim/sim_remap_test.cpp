// Slots of a plant that loses particles: one table a removal, taken by caches when they like.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesher/base/random.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/remap.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

Plant tree() {
  return make_plant(test::synthetic_bake({.branches = 4}));
}

/// What a cache remembers of a particle here: its lineage, which slots must lead back to.
struct Remembered {
  std::vector<LineageId> lineage;
  SlotCache slots;

  void take(const Plant& plant) {
    slots.take(plant.removals, [&](const Remap& remap) { remap.keep_particles(lineage); });
    for (size_t i = lineage.size(); i < plant.lineage.size(); ++i) lineage.push_back(plant.lineage[i]);
  }
};

TEST(Remap, CachesThatTakeOftenSeldomOrLateRememberTheSame) {
  Plant plant = tree();
  Remembered often, seldom;
  often.take(plant), seldom.take(plant);
  Random random(7, "remap");
  for (int i = 0; i < 40 && plant.particles.size() > 8; ++i) {
    if (i % 3 == 2) {  // a branch grows: its slots are younger than the removals before
      Branch branch{.kind = DomainKind::Branch, .length = 0.1};
      branch.lineage = child_lineage(plant.lineage[0], LineageKind::Branch, 100u + static_cast<unsigned>(i));
      const std::vector<Particle> particles(3, Particle(plant.particles.back()));
      const std::vector<Motion> motion(3, Motion(plant.motion.back()));
      append_branch(plant, branch, ParticleId(random.next() % plant.particles.size()), particles, motion);
    } else {
      remove_subtree(plant, ParticleId(1 + random.next() % (plant.particles.size() - 1)));
    }
    often.take(plant);
    ASSERT_EQ(often.lineage, plant.lineage) << "act " << i;
    if (i % 7 == 0) {
      seldom.take(plant);
      ASSERT_EQ(seldom.lineage, plant.lineage) << "act " << i;
    }
  }
  Remembered late;
  late.take(plant);
  EXPECT_EQ(late.lineage, plant.lineage) << "who comes later needs nothing from before";
  EXPECT_GT(plant.removals.epoch(), 5u);
}

TEST(Remap, ClearedRemovalsAreMissedByNobodyInSilence) {
  Plant plant = tree();
  Remembered current, stale;
  current.take(plant), stale.take(plant);
  remove_subtree(plant, plant.branches[1].particles[1]);
  current.take(plant);
  plant.removals.clear();
  current.take(plant);
  EXPECT_EQ(current.lineage, plant.lineage);
  EXPECT_ANY_THROW(stale.take(plant));
#ifndef NDEBUG
  EXPECT_ANY_THROW(stale.slots.check(plant.removals));
#endif
}

TEST(Remap, LineageStaysThroughCutsOnBothSides) {
  Plant plant = tree();
  const std::set<LineageId> before(plant.lineage.begin(), plant.lineage.end());
  ASSERT_EQ(before.size(), plant.particles.size()) << "no two have the same";
  ASSERT_TRUE(before.begin()->valid());
  const Plant whole = plant;
  Remap remap;
  DetachedFrom from;
  const Plant piece = detach_subtree(plant, plant.branches[1].particles[1], &remap, &from);
  for (size_t i = 0; i < piece.lineage.size(); ++i)
    EXPECT_EQ(piece.lineage[i], whole.lineage[from.particles[i].index()]);
  for (size_t i = 0; i < whole.lineage.size(); ++i)
    if (remap.particles[i].valid()) {
      EXPECT_EQ(plant.lineage[remap.particles[i].index()], whole.lineage[i]);
    }
  EXPECT_EQ(piece.lineage.size() + plant.lineage.size(), before.size());
}

// Two cuts in one or the other order leave the same plant in other slots of the arrays' past; the hash goes
// by id.
TEST(Remap, HashGoesById) {
  Plant first = tree(), second = tree();
  std::vector<LineageId> limbs;
  for (const Branch& branch : first.branches)
    if (branch.parent == BranchId(0)) limbs.push_back(first.lineage[branch.particles.front().index()]);
  ASSERT_GE(limbs.size(), 2u);
  const LineageId a = limbs.front(), b = limbs.back();
  const auto cut = [](Plant& plant, LineageId id) {
    const auto found = std::find(plant.lineage.begin(), plant.lineage.end(), id);
    remove_subtree(plant, ParticleId(static_cast<size_t>(found - plant.lineage.begin())));
  };
  cut(first, a), cut(first, b);
  cut(second, b), cut(second, a);
  EXPECT_EQ(state_hash(first), state_hash(second));
  Plant swapped = first;
  std::swap(swapped.motion[2], swapped.motion[3]);
  EXPECT_NE(state_hash(swapped), state_hash(first));
  std::swap(swapped.lineage[2], swapped.lineage[3]);
  EXPECT_EQ(state_hash(swapped), state_hash(first)) << "whose motion it is counts, not where it lies";
}

}  // namespace
}  // namespace liana
