// Welded skins in closed form: one closed surface around several tubes.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// A straight tube with flat ends; its radius goes linearly from root to tip.
struct SkinTube {
  Vec3 root, tip;                  ///< m
  double root_radius, tip_radius;  ///< m
};

/// The surface of the tubes' union, rounded where they meet over about `blend` (m; 0: sharp), by marching the
/// tetrahedra of a grid of spacing `cell` (m). Closed, oriented outward. Its volume is within (cell /
/// radius)² / 3 of the tubes'.
Mesh make_skin(const std::vector<SkinTube>& tubes, double cell, double blend = 0);

}  // namespace liana
