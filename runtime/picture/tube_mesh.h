// DrawTube -> a closed, tapered, round-tipped triangle mesh.
#pragma once

#include <array>
#include <vector>

#include "runtime/picture/draw_scene.h"

namespace liana {

struct TubeVertex {
  std::array<float, 3> position;  ///< m
  std::array<float, 3> normal;    ///< unit, outwards
  std::array<float, 3>
      bark;  ///< m: (r cos φ, r sin φ, distance along the tube), where the bark pattern lives
  std::array<uint8_t, 4> color;  ///< packed_color()
};

struct TubeMesh {
  std::vector<TubeVertex> vertices;
  std::vector<Triangle> triangles;  ///< counter-clockwise from outside
};

/// Appends the tube, `sides` >= 3 vertices a ring; frames are carried along without twist. Points closer than
/// a micrometre to the one before are left out; fewer than two remaining points draw nothing.
void append_tube(const DrawTube& tube, int sides, TubeMesh& mesh);

}  // namespace liana
