// What the renderer draws, in the plainest terms: the simulator, the editor and the exporters all speak it.
#pragma once

#include <vector>

#include "mesher/base/mesh.h"

namespace liana {

/// A generalised cylinder through points, with one radius each. A tube may start inside another.
struct DrawTube {
  std::vector<Vec3> points;   ///< m
  std::vector<double> radii;  ///< m
  Vec3 color = {0.36, 0.26, 0.17};  ///< linear RGB
};

/// A leaf blade: its midrib runs along the points, its flat faces look along the normals.
struct DrawLeaf {
  Vec3 base;           ///< m
  Quat orientation;    ///< local +Y is the midrib, +X the width, +Z the upper side
  double length = 0.05, width = 0.04;  ///< m
  Vec3 color = {0.16, 0.35, 0.08};
};

struct DrawMesh {
  Mesh mesh;  ///< world frame
  Vec3 color = {0.55, 0.5, 0.45};
  bool bricks = false;  ///< a procedural masonry pattern instead of the plain colour
};

struct DrawScene {
  std::vector<DrawTube> tubes;
  std::vector<DrawLeaf> leaves;
  std::vector<DrawMesh> meshes;
  Vec3 to_sun = {0.4, 0.8, 0.45};  ///< unit after normalisation, from the ground towards the sun
};

}  // namespace liana
