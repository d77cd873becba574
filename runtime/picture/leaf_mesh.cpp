#include "runtime/picture/leaf_mesh.h"

#include <cmath>

namespace liana {
namespace {

/// A point of the right half's outline and the height on the midrib it is joined to.
struct OutlinePoint {
  float x, y, midrib;
};

// From the notch at the stalk, round the basal and the side lobe, to the tip.
constexpr OutlinePoint kIvy[] = {{0.00f, 0.00f, 0.00f},  {0.10f, -0.10f, 0.00f}, {0.27f, -0.13f, 0.00f},
                                 {0.42f, -0.03f, 0.00f}, {0.36f, 0.12f, 0.14f},  {0.35f, 0.20f, 0.14f},
                                 {0.43f, 0.34f, 0.14f},  {0.50f, 0.52f, 0.30f},  {0.34f, 0.51f, 0.30f},
                                 {0.20f, 0.53f, 0.52f},  {0.17f, 0.68f, 0.52f},  {0.09f, 0.86f, 0.78f},
                                 {0.00f, 1.00f, 1.00f}};
constexpr OutlinePoint kOvate[] = {{0.00f, 0.00f, 0.00f}, {0.24f, 0.10f, 0.10f}, {0.42f, 0.25f, 0.25f},
                                   {0.50f, 0.42f, 0.42f}, {0.42f, 0.62f, 0.62f}, {0.24f, 0.80f, 0.80f},
                                   {0.08f, 0.93f, 0.92f}, {0.00f, 1.00f, 1.00f}};

/// Joins each step of the outline to the midrib; the left half mirrors the right one.
template <size_t N>
LeafShape mirrored(const OutlinePoint (&outline)[N]) {
  LeafShape shape;
  std::vector<uint32_t> midrib(N), edge[2];
  const auto add = [&](float x, float y) {
    shape.points.emplace_back(x, y);
    return uint32_t(shape.points.size() - 1);
  };
  for (size_t i = 0; i < N; ++i)
    midrib[i] =
        i > 0 && outline[i].midrib == outline[i - 1].midrib ? midrib[i - 1] : add(0, outline[i].midrib);
  for (int side = 0; side < 2; ++side)
    for (size_t i = 0; i < N; ++i)
      edge[side].push_back(outline[i].x == 0 ? midrib[i]
                                             : add(side ? -outline[i].x : outline[i].x, outline[i].y));
  const auto triangle = [&](int side, uint32_t a, uint32_t b, uint32_t c) {
    if (a == b || b == c || c == a) return;
    shape.triangles.push_back(side ? Triangle{a, c, b} : Triangle{a, b, c});
  };
  for (int side = 0; side < 2; ++side)
    for (size_t i = 0; i + 1 < N; ++i) {
      triangle(side, midrib[i], edge[side][i], edge[side][i + 1]);
      triangle(side, midrib[i], edge[side][i + 1], midrib[i + 1]);
    }
  return shape;
}

}  // namespace

const LeafShape& leaf_shape(LeafOutline outline) {
  static const LeafShape ivy = mirrored(kIvy), ovate = mirrored(kOvate);
  return outline == LeafOutline::Ivy ? ivy : ovate;
}

Vec3 blade_point(const DrawLeaf& leaf, const glm::vec2& p) {
  const double x = p.x * leaf.width, lift = kLeafFold * std::abs(x), y = p.y;
  // The midrib is a circular arc; a small curl is its limit, a straight line.
  const double turn = std::abs(leaf.curl) < 1e-3 ? 1e-3 : leaf.curl, angle = turn * y;
  return {x, leaf.length / turn * std::sin(angle) + lift * std::sin(angle),
          -leaf.length / turn * (1 - std::cos(angle)) + lift * std::cos(angle)};
}

}  // namespace liana
