// The numbers of growth that are neither a plant's nor the user's: how finely growth is cut into steps, and
// how small a change must be for nobody to see it.
#pragma once

#include <cstdint>

namespace liana {

struct GrowthWeights {
  /// Length of a new particle over a full-grown one's. Chosen: at a quarter (11 mm by default) a newborn is
  /// still five times as long as thick, so that it is a rod, and a node appears as a bud does, not as a
  /// segment.
  double youngest_segment = 0.25;
  /// Mass of a new particle over a full-grown one's. What appears at once changes the mass of the shoot that
  /// it appears on: of a shoot of ten particles by 0.2 %, a fifth of unseen_jump.
  double newborn_mass = 0.02;
  /// Growth s; longer steps are cut. A tip turns by surface adaption's 4 rad/s at most: 0.2 rad, within which
  /// sin x is x to 0.7 %.
  double longest_step = 0.05;
  /// Of a tip's speed, that one step's calibration may change it by. Observers tell speeds apart from 5 %
  /// [McKee 1981], a fifth of that is left to the other changes of a step.
  double unseen_jump = 0.01;
  /// Of a stiffness, beyond what its growth changes it by in that step: the same share for slow branches, of
  /// which unseen_jump/(ωΔt)² would allow any.
  double most_at_once = 0.01;
  /// Growth s, in which a bent joint gets used to its new stiffness. Chosen: about twice what a segment takes
  /// to grow (0.045 m at 0.085 m/s: 0.53 s); a plant that sways at 1 Hz does not take its swings for its
  /// shape.
  double forget = 1;
  /// Of the petiole's radius, what a leaf adds to the stems below as a strand. With the pipe model's n = 2
  /// and the default petiole a stem below 100 leaves is 2.8 mm in radius, below 1000 leaves 8.9 mm. Chosen by
  /// that; a count of leaves above measured stems would answer it.
  double leaf_strand = 0.35;
  uint64_t hold_turns = 64;     ///< steps of growth in which every stem is tried for a hold once
  uint64_t settle_turns = 100;  ///< calls in which every branch is calibrated finely once

  /// Exponent of the length that a branch's stiffness scale goes with while it grows. The law asks for ω ~
  /// ℓ^ε₁, a cantilever of one section swings at ω² ~ 1/ℓ⁴, a blade on its petiole too (its moment of inertia
  /// goes with the fourth power of its size): what is asked over what is there goes with ℓ^(4 + 2ε₁).
  static constexpr double stiffness_by_length(double epsilon1) {
    return 4 + 2 * epsilon1 > 0 ? 4 + 2 * epsilon1 : 0;
  }
};

inline constexpr GrowthWeights kGrowth;

}  // namespace liana
