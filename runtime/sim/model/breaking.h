// Where a plant breaks: the stress in its joints against what its branches bear.
//
// Wood that grew under a load is free of stress there, so the rest load of a joint counts for nothing: what
// loads it is C e, the moment and force by which it is strained from where it grew.
#pragma once

#include <vector>

#include "runtime/sim/model/plant.h"

namespace liana {

/// Largest normal stress (Pa) in the outer fibre of a particle's joint: √((M_x b/I_x)² + (M_z a/I_z)²) +
/// |N|/A over the elliptic section there (a half width, b half thickness). 0 for a loose root.
double joint_stress(const Plant& plant, ParticleId particle);

/// What a joint would give back if it were let go: ½ (C e − rest load)² / C, J. Never negative; this is what
/// is lost when it breaks. Over all joints it differs from Joint's U by a constant.
double joint_energy(const Plant& plant, ParticleId particle);

/// Sets what every branch bears: its group's modulus of rupture over `sensitivity`, which is [Haedrich17]'s
/// t_s in [0, 1]: 1 breaks as its wood does, 0 never. Returns how many branches are of a group of which
/// nothing is known: they do not break.
size_t set_strengths(Plant& plant, const SpeciesLaw& law, double sensitivity);

struct Fracture {
  ParticleId at;  ///< holds no longer to its parent
  double stress;  ///< Pa
};

/// Joints loaded beyond their Branch::strength, the most overloaded first, at most `most` of them. Of two of
/// which one grows from the other only the worse breaks: the other is relieved by it. Replaces `found`.
void find_fractures(const Plant& plant, size_t most, std::vector<Fracture>& found);

}  // namespace liana
