// DrawTube -> a closed, tapered, round-tipped triangle mesh.
#pragma once

#include <vector>

#include "runtime/picture/draw_scene.h"
#include "runtime/picture/glm_types.h"

namespace liana {

struct TubeVertex {
  glm::vec3 position;  ///< m
  glm::vec3 normal;    ///< unit, outwards
  glm::vec3 bark;      ///< m: (r cos φ, r sin φ, distance along the tube), where the bark pattern lives
  glm::u8vec4 color;   ///< packed_color()
};

struct TubeMesh {
  std::vector<TubeVertex> vertices;
  std::vector<Triangle> triangles;  ///< counter-clockwise from outside
};

/// Appends the tube, `sides` >= 3 vertices a ring; frames are carried along without twist. Points closer than
/// a micrometre to the one before are left out; fewer than two remaining points draw nothing.
void append_tube(const DrawTube& tube, int sides, TubeMesh& mesh);

}  // namespace liana
