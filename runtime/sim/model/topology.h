// Changing a plant's tree between two steps: a branch more, a branch less, a branch on its own.
//
// A stepper notices by itself; what remains keeps its place, motion and calibration to the bit. Appending
// single particles needs nothing from here: parents first, ids never change.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"

namespace liana {

/// Appends one particle to the end of a branch, with the lineage that follows from the branch's.
/// particle.parent must be set.
ParticleId append_particle(Plant& plant, BranchId branch, const Particle& particle, const Motion& motion);

/// A chain that grows from `at`: fills in parent, branch and ids. particles[i] is held by the one before, the
/// first by `at` (invalid: by the world). branch.particles is set here. Both arrays root to tip, of equal
/// length, not empty.
BranchId append_branch(Plant& plant, Branch branch, ParticleId at, std::span<const Particle> particles,
                       std::span<const Motion> motion);

/// Takes `root` and all that grows from it away, with its anchors. Branches that lose all particles go; the
/// one that is cut through keeps its lower part, its length shortened. What remains keeps its order and moves
/// up in the arrays. Returns where things went, which plant.removals keeps as its last entry.
const Remap& remove_subtree(Plant& plant, ParticleId root);

/// The same, and what was taken is returned as a plant of its own that nothing holds: it falls as it moved,
/// keeps its joints and anchors, and its swinging is damped as before, its flight is not. For each of its
/// particles and branches, `from` (when given) receives the id that it had.
struct DetachedFrom {
  std::vector<ParticleId> particles;
  std::vector<BranchId> branches;
};
Plant detach_subtree(Plant& plant, ParticleId root, Remap* change = nullptr, DetachedFrom* from = nullptr);

/// Keeps carried_masses() up to date: `mass` (kg, negative for what is taken away) was added where it grows
/// from particle `at`, in a branch other than `branch`'s own. In the time of the path to the root.
void add_carried(const Plant& plant, ParticleId at, BranchId branch, double mass,
                 std::vector<double>& carried);

/// kg, of a particle and all that grows from it. In the time of the branches after it.
double subtree_mass(const Plant& plant, ParticleId root);

}  // namespace liana
