// Bakes and plants built in code, for whatever needs a plant but not the offline stage.
#pragma once

#include "materials/bake/bake.h"
#include "runtime/sim/model/plant.h"

namespace liana::test {

struct TreeShape {
  int branches = 8;                                 ///< on the trunk
  int twigs = 3;                                    ///< on every branch
  int leaves = 2;                                   ///< on every twig
  double height = 2.5;                              ///< m
  double trunk_frequency = 1.2;                     ///< Hz; shorter domains swing faster, ν ~ ℓ^-0.59
  double damping_low = 0.0065, damping_high = 0.1;  ///< ξ at and below 1 Hz, at and above 3 Hz
};

/// A tapered, slightly curved trunk with branches, twigs and flat leaves. Deterministic.
Bake synthetic_bake(const TreeShape& shape = {});

/// One domain: a straight rod of constant circular section standing on the origin, along +Y.
struct RodShape {
  double length = 1, radius = 0.01;  ///< m
  double youngs_modulus = 8.77e9, density = 745;
  double frequency = 1, damping_factor = 0.05;
  double flatness = 1;  ///< half width over half thickness
};
Bake rod_bake(const RodShape& shape = {});

/// A rod as a chain of n equal particles with its physical stiffness: not calibrated, no rest loads.
Plant rod_plant(const RodShape& shape, int particles);

}  // namespace liana::test
