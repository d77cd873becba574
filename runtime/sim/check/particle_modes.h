// The lowest modes of a whole plant as the simulator moves it: particles and joints, linearised at rest.
//
// Symbols: K = Σ Jᵀ C J joint stiffness at rest, M masses and inertias, K φ = ω² M φ. A plant that stands on
// its roots alone is statically determinate: K⁻¹ is one sweep of wrenches from the tips and one of strains
// back, linear in the number of particles and exact at any ratio of stiffnesses (as in HeldChain).
#pragma once

#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/joints.h"

namespace liana {

struct ParticleModes {
  std::vector<double> frequencies;  ///< Hz, ascending
  std::vector<std::vector<Vec6>>
      shapes;  ///< per mode and particle: (translation of its centre, rotation), world
  int iterations = 0;
  bool converged = false;  ///< the last frequency changed by less than 1e-8
};

/// Neither anchors, gravity's loads nor contacts: what the joints alone do. count is cut to what the plant
/// has. Frequencies are those of the joints as they are, which calibration has set for plant.scheme; with a
/// step of 10 µs they are those of the bake to 1e-6.
ParticleModes particle_modes(const Plant& plant, int count);

/// Modal assurance criterion of two displacement fields at the particles' centres, weighed by mass: 1 where
/// one is a multiple of the other, 0 where they are orthogonal.
double assurance(const Plant& plant, const std::vector<Vec3>& a, const std::vector<Vec3>& b);

}  // namespace liana
