// Lineage ids and the draws that are keyed by them.
#include "mesher/base/ids.h"

#include <gtest/gtest.h>

#include <set>

#include "mesher/base/random.h"

namespace liana {
namespace {

TEST(Lineage, DiffersByParentKindAndOrdinal) {
  std::set<LineageId> ids;
  std::vector<LineageId> parents = {plant_lineage("ivy", 1), plant_lineage("ivy", 2),
                                    plant_lineage("oak", 1)};
  size_t made = 0;
  for (int generation = 0; generation < 3; ++generation) {
    std::vector<LineageId> children;
    for (const LineageId parent : parents)
      for (const LineageKind kind : {LineageKind::Branch, LineageKind::Segment, LineageKind::Leaf})
        for (uint64_t ordinal = 0; ordinal < 12; ++ordinal) {
          children.push_back(child_lineage(parent, kind, ordinal));
          ids.insert(children.back());
          ++made;
        }
    parents = std::move(children);
  }
  EXPECT_EQ(ids.size(), made);
  EXPECT_FALSE(ids.contains(LineageId()));
  EXPECT_EQ(child_lineage(plant_lineage("ivy", 1), LineageKind::Leaf, 3),
            child_lineage(plant_lineage("ivy", 1), LineageKind::Leaf, 3));
}

TEST(Draws, AreUniformAndNormal) {
  const Draws draws(5, plant_lineage("ivy", 1), "test");
  constexpr int kCount = 200'000;
  double mean = 0, square = 0, normal = 0, normal_square = 0, normal_fourth = 0;
  for (uint64_t i = 0; i < kCount; ++i) {
    const double u = draws.uniform(i), n = draws.normal(i);
    ASSERT_TRUE(u >= 0 && u < 1);
    mean += u / kCount, square += u * u / kCount;
    normal += n / kCount, normal_square += n * n / kCount, normal_fourth += n * n * n * n / kCount;
  }
  // Five standard errors: of the mean σ/√N, of the mean square √((μ₄ − σ⁴)/N).
  const double root = std::sqrt(kCount);
  EXPECT_NEAR(mean, 0.5, 5 * std::sqrt(1 / 12.0) / root);
  EXPECT_NEAR(square, 1 / 3.0, 5 * std::sqrt(4 / 45.0) / root);
  EXPECT_NEAR(normal, 0, 5 / root);
  EXPECT_NEAR(normal_square, 1, 5 * std::sqrt(2) / root);
  EXPECT_NEAR(normal_fourth, 3, 5 * std::sqrt(96) / root);
}

// The k-th numbers of neighbouring ids, and of one id for two purposes, have nothing to do with each other.
TEST(Draws, OfDifferentThingsAreIndependent) {
  constexpr int kCount = 100'000;
  const LineageId plant = plant_lineage("ivy", 1);
  double next = 0, purpose = 0, ordinal = 0;
  for (uint64_t i = 0; i < kCount; ++i) {
    const LineageId id = child_lineage(plant, LineageKind::Segment, i),
                    other = child_lineage(plant, LineageKind::Segment, i + 1);
    const double x = Draws(5, id, "a").uniform(0) - 0.5;
    next += x * (Draws(5, other, "a").uniform(0) - 0.5);
    purpose += x * (Draws(5, id, "b").uniform(0) - 0.5);
    ordinal += x * (Draws(5, id, "a").uniform(1) - 0.5);
  }
  const double five_errors = 5 / 12.0 * std::sqrt(kCount);
  EXPECT_LT(std::abs(next), five_errors);
  EXPECT_LT(std::abs(purpose), five_errors);
  EXPECT_LT(std::abs(ordinal), five_errors);
}

}  // namespace
}  // namespace liana
