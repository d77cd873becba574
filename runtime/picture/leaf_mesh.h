// The shapes of leaf blades: flat outlines in a unit square, and how a blade folds and bends.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/picture/draw_scene.h"

namespace liana {

/// A flat blade: base at the origin, tip at (0, 1); half widths reach 0.5. Triangles face +Z.
struct LeafShape {
  std::vector<glm::vec2> points;
  std::vector<Triangle> triangles;
};

const LeafShape& leaf_shape(LeafOutline outline);

/// How far the halves of a blade rise from the midrib, m per m of width from it.
constexpr float kLeafFold = 0.28f;

/// A point of the blade in the leaf's frame, m: folded along the midrib, which bends by leaf.curl towards -Z.
Vec3 blade_point(const DrawLeaf& leaf, const glm::vec2& shape_point);

}  // namespace liana
