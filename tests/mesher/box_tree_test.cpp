#include "mesher/geometry/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/base/random.h"

namespace liana {
namespace {

TEST(BoxTree, FindsWhatASearchThroughAllFinds) {
  Random random(1, "boxes");
  const auto point = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 500; ++i) {
    const Vec3 low = point();
    boxes.emplace_back(low, low + 0.1 * point());
  }
  const BoxTree tree(boxes);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = point();
    const double reach = 0.2 * random.uniform();
    std::vector<uint32_t> found, all;
    tree.near(p, reach, [&](uint32_t item) { found.push_back(item); });
    for (uint32_t b = 0; b < boxes.size(); ++b)
      if (boxes[b].squaredExteriorDistance(p) <= reach * reach) all.push_back(b);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, all);
  }
}

TEST(BoxTree, FindsEveryPairThatMeetsOnce) {
  Random random(2, "boxes");
  const auto point = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
  for (const size_t count : {0, 1, 7, 400}) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (size_t i = 0; i < count; ++i) {
      const Vec3 low = point();
      boxes.emplace_back(low, low + 0.1 * point());
    }
    std::vector<std::pair<uint32_t, uint32_t>> found, all;
    const bool stopped = BoxTree(boxes, 3).any_pair([&](uint32_t a, uint32_t b) {
      found.push_back(std::minmax(a, b));
      return false;
    });
    EXPECT_FALSE(stopped);
    for (uint32_t a = 0; a < count; ++a)
      for (uint32_t b = a + 1; b < count; ++b)
        if (boxes[a].intersects(boxes[b])) all.push_back({a, b});
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, all);
  }
}

}  // namespace
}  // namespace liana
