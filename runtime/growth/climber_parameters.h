// Everything a user can set of a climbing plant's growth. The defaults make an ivy that climbs 3 m in 45 s.
//
// Growth seconds are simulated seconds times a speed of the user's choice; all rates here are per growth
// second.
#pragma once

#include <cstddef>

#include "mesher/base/types.h"

namespace liana {

struct TropismParameters {
  double surface_adaption = 4;     ///< τ of [Haedrich17] Eq. 6, rad/s
  double phototropism = 0.25;      ///< η of Eq. 7, rad/s
  double climbing = 1.5;           ///< rad/s, towards the shoot's own upward course on the surface
  double wander = 0.5;             ///< rad/√s, random turning on the surface
  double search_radius = 0.6;      ///< m, within which a support is felt
  double cling_gap = 2e-3;         ///< m between stem and surface that a tip keeps
  double approach_length = 0.025;  ///< m, over which a tip eases from approaching to following the surface
  double approach_angle = 1.2;     ///< rad to the surface, of a tip far from it
};

struct BranchingParameters {
  double probability = 0.08;  ///< of a lateral shoot at a node ([Haedrich17] Table 2: BP)
  double variance = 0.3;      ///< V in [0, 1]: 1 lets a lateral leave up to 90° off its usual angle
  double angle = 0.85;        ///< rad between a lateral and its parent
  double falloff = 0.85;      ///< f of t_c = t_p f, tip radius of a lateral over its parent's
  unsigned max_laterals = 1;  ///< per node (Table 2: B)
  int max_level = 3;
  double room = 0.1;  ///< m: a bud breaks only where no other stem is that near to its way
};

struct LeafParameters {
  double step = 0.04;       ///< m of stem between leaves (phyllotaxis)
  double divergence = kPi;  ///< rad about the stem from leaf to leaf; π: left, right, left, as ivy on a wall
  double length = 0.055;    ///< m, of the full-grown blade
  double width = 0.055;     ///< m
  double thickness = 3e-4;  ///< m
  double petiole = 0.03;    ///< m
  double petiole_radius = 8e-4;  ///< m
  double variation = 0.25;       ///< of size and direction, random
  double seconds_to_full = 6;    ///< growth seconds
  double phototropism = 0.25;    ///< rad/s, of the blade while it grows
};

struct AnchorParameters {
  double touch_gap = 8e-3;          ///< m: a stem nearer than this puts roots on the surface
  double stiffness = 400;           ///< N/m of an anchor of a young stem; grows with the stem's width
  double damping_time = 0.05;       ///< s, damping over stiffness
  double seconds_to_full = 2;       ///< growth seconds over which an anchor hardens
  double release_distance = 0.008;  ///< m, beyond which it tears off, if it does not before the stem would
};

struct ClimberParameters {
  double elongation = 0.085;      ///< m/s of a fully lit tip
  double shade = 0.5;             ///< what full shade leaves of that
  double segment_length = 0.045;  ///< m, of a full-grown particle
  double tip_radius = 1.2e-3;     ///< m, of the first shoots
  unsigned first_shoots = 5;      ///< from one seed
  double fan = 0.8;               ///< rad: their courses spread from -fan to +fan about upwards
  double longest_shoot = 5;       ///< m; halved with every level
  double longest_free = 0.35;     ///< m without hold, after which a tip stops
  double pipe_exponent = 2;       ///< n: a stem's rⁿ is the sum of those it carries (pipe model)
  double thickening = 0.12;       ///< 1/s, largest relative growth of a radius
  double recalibration =
      0.1;                ///< relative change of a branch's length or mass that lets it be calibrated at once
  double settled = 1e-3;  ///< the same, of a branch whose turn it is: all take turns, within 2.5 s at 25 ms
  double weight_grown_in = 1;    ///< share of the weight that wood is shaped by; less: free shoots sag
  double strength = 0;           ///< Pa that stems bear before they break; 0: any
  double leaf_strength = 0;      ///< Pa that leaves bear
  Vec3 gravity = {0, -9.81, 0};  ///< m/s², that the plant grows under
  /// Stems and leaves; laterals stop at 55-85 % of it, leaders at all of it. All shoots draw on it: near it,
  /// what one does not grow another may.
  size_t max_particles = 5000;
  TropismParameters tropisms;
  BranchingParameters branching;
  LeafParameters leaves;
  AnchorParameters anchors;
};

}  // namespace liana
