// A baked plant as particles: the same masses, standing as modelled, swinging as baked.
#pragma once

#include "runtime/sim/calibrate/calibration.h"

namespace liana {

struct PlacementOptions {
  Vec3 position = Vec3::Zero();  ///< m, where the bake's origin comes to stand
  double yaw = 0;                ///< rad, about +Y
  double spacing = 0;  ///< m, wanted length of a particle; 0: 4 diameters for branches, 15 cm for leaves
  TimeScheme scheme;   ///< wanted; see calibrate_plant
  Vec3 gravity = {0, -9.81, 0};  ///< m/s², that the plant was modelled under
};

/// Chains of 4-24 particles along each branch's centreline (1-8 for a leaf), masses summing to the domain's,
/// children attached to the nearest point of their parent's chain, joints calibrated, their rest loads
/// carrying the weight. plant.branches[i] is bake.domains[i]. Throws Error{Input} naming a domain that cannot
/// become a chain. `report`, when given, receives what calibration decided.
Plant make_plant(const Bake& bake, const PlacementOptions& options = {}, CalibrationReport* report = nullptr);

}  // namespace liana
