// Discrete calibration: joint stiffness and damping such that a branch, moved by the step itself, swings at
// its baked frequency and decays with its baked damping factor.
//
// Symbols: ν frequency (Hz), ξ damping factor, ω = 2πν; k* (1/s²), c* (1/s) stiffness and damping per unit
// mass that the step turns into ν and ξ; ω₁² lowest eigenvalue of the branch's chain, its parent held, the
// mass of its descendants lumped on the particles they grow from; d_M (1/s), d_K (s) mass and stiffness
// damping.
//   joints × k*/ω₁²  ([Wang17] Eq. 10 for the simulator);   c* = d_M + d_K k*, in the bake's proportion  d_M
//   : d_K ω²
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "runtime/sim/calibrate/held_chain.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct CalibrationReport {
  size_t branches = 0;
  TimeScheme scheme;                    ///< what the plant is integrated with from now on
  std::vector<BranchId> beyond_wanted;  ///< branches that the wanted scheme could not have served
  std::vector<BranchId> out_of_range;   ///< branches that no scheme serves as baked; left as near as can be
  std::string note;                     ///< one sentence when the scheme is not the wanted one; else empty
};

/// Chooses plant.scheme (the smallest change from `wanted` that serves every branch) and calibrates every
/// branch. Branches must hold their targets (Branch::material), joints their physical stiffness ×
/// Branch::stiffness_scale.
CalibrationReport calibrate_plant(Plant& plant, const TimeScheme& wanted = {});

/// Calibrates one branch again, for plant.scheme, after its length, mass, material or particles changed. Does
/// not pop: what every joint exerts at this moment is kept (see set_stiffness). carried:
/// carried_masses(plant). Reuses `chain`. False when the scheme cannot serve the target: the branch is then
/// as near as can be; calibrate_plant() may help. most: natural logarithm of the largest factor by which the
/// stiffness may change now.
bool recalibrate(Plant& plant, BranchId branch, std::span<const double> carried, HeldChain& chain,
                 double most = std::numeric_limits<double>::infinity());

/// Changes a joint's stiffness without changing the wrench that it exerts at this moment: the difference goes
/// into its rest load, as wood that grows on a bent shoot is free of stress there.
void set_stiffness(Plant& plant, ParticleId particle, const Vec3& shear, const Vec3& bend);

}  // namespace liana
