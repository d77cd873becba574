#include "mesher/geometry/polygon.h"

namespace liana {
namespace {

constexpr size_t kMaxEars = 256;  // clipping takes the cube of it at worst

void append_fan(std::span<const uint32_t> corners, std::vector<Triangle>& triangles) {
  for (size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace

void append_polygon(std::span<const uint32_t> corners, const std::vector<Vec3>& positions,
                    std::vector<Triangle>& triangles) {
  if (corners.size() == 3 || corners.size() > kMaxEars) return append_fan(corners, triangles);
  const auto at = [&](uint32_t corner) -> const Vec3& { return positions[corner]; };
  Vec3 normal = Vec3::Zero();
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (at(corners[i]) - at(corners[0])).cross(at(corners[i + 1]) - at(corners[0]));
  const auto turn = [&](uint32_t a, uint32_t b, uint32_t c) {  // twice the area seen along the normal
    return normal.dot((at(b) - at(a)).cross(at(c) - at(a)));
  };
  std::vector<uint32_t> left(corners.begin(), corners.end());
  const auto is_ear = [&](size_t i) {
    const uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                   c = left[(i + 1) % left.size()];
    if (!(turn(a, b, c) > 0)) return false;
    for (const uint32_t p : left)
      if (p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
        return false;
    return true;
  };
  while (left.size() > 3) {
    size_t ear = 0;
    while (ear < left.size() && !is_ear(ear)) ++ear;
    if (ear == left.size()) break;  // crossed or without area
    triangles.push_back(
        {left[(ear + left.size() - 1) % left.size()], left[ear], left[(ear + 1) % left.size()]});
    left.erase(left.begin() + static_cast<ptrdiff_t>(ear));
  }
  append_fan(left, triangles);
}

}  // namespace liana
