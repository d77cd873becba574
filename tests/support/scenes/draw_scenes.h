// Scenes for the renderer, built in code: what a finished simulation looks like, without one.
#pragma once

#include <cmath>
#include <random>

#include "runtime/picture/draw_scene.h"

namespace liana::support {

/// An axis-aligned box, outward triangles.
inline Mesh box_mesh(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                corner & 4 ? high.z() : low.z());
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

/// Uniform numbers that are the same everywhere (the standard's distributions are not).
class Dice {
 public:
  explicit Dice(uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }

 private:
  std::mt19937 engine_;
};

/// A blade whose midrib points along `midrib` and whose upper side looks towards `upper`.
inline DrawLeaf leaf_at(const Vec3& base, const Vec3& midrib, const Vec3& upper, double length) {
  Mat3 frame;
  frame.col(1) = midrib.normalized();
  frame.col(0) = frame.col(1).cross(upper).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  DrawLeaf leaf;
  leaf.base = base;
  leaf.orientation = Quat(frame);
  leaf.length = length;
  leaf.width = 0.9 * length;
  return leaf;
}

/// One shoot that wanders up the wall z = 0 with a leaf every few centimetres; side shoots below `depth` 2.
inline void add_vine(DrawScene& scene, Dice& dice, Vec3 at, double heading, double length, double radius,
                     int depth) {
  DrawTube tube;
  tube.color = {0.17, 0.115, 0.065};
  const double step = 0.03;
  const int steps = int(length / step);
  for (int i = 0; i <= steps; ++i) {
    const double part = double(i) / steps, thick = radius * (1 - 0.8 * part);
    tube.points.push_back({at.x(), at.y(), thick + 0.004 + 0.006 * std::sin(9 * part + 5 * heading)});
    tube.radii.push_back(thick);
    if (i > 2 && dice.between(0, 1) < 0.55) {
      const Vec3 out(dice.between(-0.9, 0.9), dice.between(-0.5, 0.5), dice.between(0.25, 0.7));
      const double size = dice.between(0.045, 0.095) * (1 - 0.45 * part);
      const Vec3 tip = tube.points.back() + 0.7 * size * out.normalized();
      scene.tubes.push_back({{tube.points.back(), tip}, {0.0014, 0.0009}, {0.20, 0.24, 0.08}, {}});
      DrawLeaf leaf =
          leaf_at(tip, Vec3(0.5 * out.x(), -0.75, 0.5 * out.z()), Vec3(0.5 * out.x(), 0.55, 1.0), size);
      leaf.color = Vec3(0.060, 0.165, 0.035) * dice.between(0.75, 1.5) + Vec3(0.03, 0.03, 0) * part;
      leaf.curl = dice.between(0.2, 0.8);
      scene.leaves.push_back(leaf);
    }
    if (depth < 2 && i > 6 && dice.between(0, 1) < (depth ? 0.05 : 0.13))
      add_vine(scene, dice, tube.points.back(), heading + (dice.between(0, 1) < 0.5 ? -0.75 : 0.75),
               length * dice.between(0.25, 0.5) * (1 - 0.4 * part), 0.6 * thick, depth + 1);
    heading = 0.93 * heading + dice.between(-0.22, 0.22);
    at += step * Vec3(std::sin(heading), std::cos(heading), 0);
    at.y() = std::max(at.y(), 0.02);
  }
  scene.tubes.push_back(tube);
}

/// A branch of a small tree, its side branches and its leaves.
inline void add_limb(DrawScene& scene, Dice& dice, Vec3 at, Vec3 way, double length, double radius,
                     int depth) {
  DrawTube tube;
  tube.color = {0.21, 0.155, 0.105};
  const int steps = 8;
  const double turn = dice.between(0, 6.28);
  for (int i = 0; i <= steps; ++i) {
    const double part = double(i) / steps, flare = depth == 0 ? 0.7 * std::exp(-12 * part) : 0;
    tube.points.push_back(at);
    tube.radii.push_back(radius * (1 - 0.62 * part + flare));
    if (depth < 3 && i >= (depth == 0 ? 3 : 2)) {
      for (int k = 0; k < (depth == 0 ? 2 : 1); ++k) {
        const double angle = turn + 2.4 * i + 3.14 * k;
        const Vec3 side = way.unitOrthogonal(), other = way.cross(side);
        const Vec3 out =
            0.75 * (std::cos(angle) * side + std::sin(angle) * other) + 0.65 * way + Vec3(0, 0.15, 0);
        add_limb(scene, dice, at, out.normalized(), length * dice.between(0.40, 0.58) * (1 - 0.3 * part),
                 0.5 * tube.radii.back(), depth + 1);
      }
    }
    if (depth >= 2 && i > 1) {
      const Vec3 out =
          (Vec3(dice.between(-1, 1), dice.between(-0.5, 0.8), dice.between(-1, 1)) + 0.6 * way).normalized();
      DrawLeaf leaf =
          leaf_at(at + 0.01 * out, out, Vec3(0.2 * out.x(), 1, 0.2 * out.z()), dice.between(0.05, 0.085));
      leaf.width = 0.55 * leaf.length;
      leaf.outline = LeafOutline::Ovate;
      leaf.color = Vec3(0.115, 0.215, 0.042) * dice.between(0.75, 1.35);
      scene.leaves.push_back(leaf);
    }
    way = (way + 0.12 * Vec3(dice.between(-1, 1), dice.between(-0.2, 0.9), dice.between(-1, 1))).normalized();
    at += length / steps * way;
  }
  scene.tubes.push_back(tube);
}

/// A brick wall of 3 m with a climber on it and a small tree beside it.
inline DrawScene wall_scene() {
  DrawScene scene;
  Dice dice(7);
  scene.meshes.push_back({box_mesh({-1.7, 0, -0.24}, {1.7, 3, 0}), {0.31, 0.135, 0.09}, true, "wall"});
  scene.meshes.push_back(
      {box_mesh({-1.75, 3, -0.28}, {1.75, 3.06, 0.04}), {0.50, 0.47, 0.42}, false, "coping"});
  for (const double x : {-0.55, -0.1, 0.3}) add_vine(scene, dice, {x, 0.02, 0}, 0.15 * x, 3.1, 0.012, 0);
  add_limb(scene, dice, {2.75, -0.02, 0.6}, Vec3(0.05, 1, 0), 2.3, 0.045, 0);
  scene.to_sun = {-0.55, 0.75, 0.65};
  return scene;
}

}  // namespace liana::support
