// Plant -> tubes and leaves: one smooth tube per branch, one blade per leaf.
#pragma once

#include <string_view>

#include "runtime/picture/draw_scene.h"
#include "runtime/sim/model/plant.h"

namespace liana {

/// What a species looks like. Colours are linear RGB.
struct PlantLook {
  Vec3 bark = {0.21, 0.155, 0.105};
  Vec3 green_stem = {0.16, 0.19, 0.065};  ///< of stems thinner than a few millimetres
  Vec3 leaf = {0.105, 0.205, 0.042};
  LeafOutline outline = LeafOutline::Ovate;
  double leaf_curl = 0.4;  ///< rad, of a blade at rest
};

/// By the species' name ("ivy", "birch", ...); an unknown one gets the default look.
PlantLook plant_look(std::string_view species);

struct PlantDrawingOptions {
  int points_per_particle = 3;  ///< of a tube's curve, >= 1
  bool names = false;           ///< name every tube and leaf, for export
};

/// Appends the plant as it stands. Tubes start on the parent's centreline, so forks have no gap. Shades vary
/// from branch to branch and leaf to leaf by their ids alone, so they stay as the plant grows.
void add_plant(const Plant& plant, const PlantLook& look, const PlantDrawingOptions& options,
               DrawScene& scene);

}  // namespace liana
