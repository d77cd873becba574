// What the renderer draws, in the plainest terms: the simulator, the editor and the exporters all speak it.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// A generalised cylinder through points, with one radius each. A tube may start inside another.
struct DrawTube {
  std::vector<Vec3> points;         ///< m
  std::vector<double> radii;        ///< m
  Vec3 color = {0.36, 0.26, 0.17};  ///< linear RGB
  std::string name;                 ///< of its node in an exported file; may be empty
};

enum class LeafOutline : uint8_t {
  Ivy,    ///< five lobes, palmate veins
  Ovate,  ///< egg-shaped with a pointed tip, pinnate veins
};
constexpr int kLeafOutlineCount = 2;

/// A leaf blade: its midrib starts at the base and bends down by `curl` towards the tip.
struct DrawLeaf {
  Vec3 base = Vec3::Zero();             ///< m, where the stalk meets the blade
  Quat orientation = Quat::Identity();  ///< local +Y is the midrib, +X the width, +Z the upper side
  double length = 0.05, width = 0.04;   ///< m
  Vec3 color = {0.16, 0.35, 0.08};      ///< linear RGB
  LeafOutline outline = LeafOutline::Ivy;
  double curl = 0.5;  ///< rad, the midrib's turn from base to tip, towards -Z
  std::string name;   ///< of its node in an exported file; may be empty
};

struct DrawMesh {
  Mesh mesh;  ///< world frame
  Vec3 color = {0.55, 0.5, 0.45};
  bool bricks = false;  ///< a procedural masonry pattern instead of plaster of the plain colour
  std::string name;     ///< of its node in an exported file; may be empty
};

/// A thin line of the same width on any picture: moving air, say. Casts no shadow and is not exported.
struct DrawStreak {
  Vec3 from, to;       ///< m; fades towards `from`
  Vec3 color;          ///< linear RGB
  double opacity = 1;  ///< at `to`
};

struct DrawScene {
  std::vector<DrawTube> tubes;
  std::vector<DrawLeaf> leaves;
  std::vector<DrawMesh> meshes;
  std::vector<DrawStreak> streaks;
  Vec3 to_sun = {0.4, 0.8, 0.45};  ///< unit after normalisation, from the ground towards the sun
  bool ground = true;              ///< draw the ground, the plane y = 0
};

struct BoundingBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(low.x() <= high.x()); }
  void add(const Vec3& point, double margin = 0) {
    low = low.cwiseMin(Vec3(point.array() - margin));
    high = high.cwiseMax(Vec3(point.array() + margin));
  }
};

/// Box around tubes, leaves and meshes (not streaks), m; empty() for an empty scene.
BoundingBox bounding_box(const DrawScene& scene);

}  // namespace liana
