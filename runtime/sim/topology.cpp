#include "runtime/sim/topology.h"

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {
namespace {

// Calls visit(i) for a particle and all that grows from it, parents first.
template <class Visit>
std::vector<bool> mark_subtree(const Plant& plant, ParticleId root, Visit&& visit) {
  std::vector<bool> marked(plant.particles.size(), false);
  for (size_t i = root.index(); i < plant.particles.size(); ++i) {
    const ParticleId parent = plant.particles[i].parent;
    if (i != root.index() && !(parent.valid() && marked[parent.index()])) continue;
    marked[i] = true;
    visit(i);
  }
  return marked;
}

// The taken particles as a plant: ids by their order.
Plant copy_of(const Plant& plant, std::span<const ParticleId> taken, DetachedFrom& from) {
  Plant piece;
  piece.name = plant.name;
  piece.scheme = plant.scheme;
  std::vector<ParticleId> now(plant.particles.size());
  std::vector<BranchId> branch_now(plant.branches.size());
  for (const ParticleId id : taken) {
    Particle particle = plant.particles[id.index()];
    BranchId& branch = branch_now[particle.branch.index()];
    if (!branch.valid()) {
      branch = BranchId(piece.branches.size());
      Branch own = plant.branches[particle.branch.index()];
      own.parent = own.parent.valid() ? branch_now[own.parent.index()] : BranchId();
      own.particles.clear();
      piece.branches.push_back(std::move(own));
      from.branches.push_back(particle.branch);
    }
    now[id.index()] = ParticleId(piece.particles.size());
    piece.branches[branch.index()].particles.push_back(now[id.index()]);
    particle.branch = branch;
    if (piece.particles.empty())
      particle.parent = ParticleId();
    else
      particle.parent = now[particle.parent.index()];
    piece.particles.push_back(particle);
    piece.motion.push_back(plant.motion[id.index()]);
  }
  for (WorldSpring anchor : plant.anchors) {
    anchor.particle = now[anchor.particle.index()];
    if (anchor.particle.valid()) piece.anchors.push_back(anchor);
  }
  return piece;
}

// Leaves vary in look by their particle's id, stems by their own: what is seen must not change with them.
void remember_shades(Plant& plant) {
  for (uint32_t b = 0; b < plant.branches.size(); ++b) {
    Branch& branch = plant.branches[b];
    if (branch.shade != Branch::kNoShade) continue;
    const bool leaf = branch.kind == DomainKind::Leaf && !branch.particles.empty();
    branch.shade = leaf ? branch.particles.front().value : b;
  }
}

double length_of(const Plant& plant, std::span<const ParticleId> particles) {
  double length = 0;
  for (const ParticleId p : particles) length += 2 * plant.particles[p.index()].half_length;
  return length;
}

// Mass damping acts on all motion, so it would brake the fall: its share of c* = d_M + d_K ω² goes to the
// joints.
void let_fly(Plant& piece) {
  Joint& joint = piece.particles[0].joint;
  joint.shear_stiffness = joint.bend_stiffness = joint.rest_force = joint.rest_moment = Vec3::Zero();
  for (Particle& particle : piece.particles) {
    const double omega = 2 * kPi * piece.branches[particle.branch.index()].material.frequency;
    if (omega > 0) particle.stiffness_damping += particle.mass_damping / (omega * omega);
    particle.mass_damping = 0;
  }
}

}  // namespace

BranchId append_branch(Plant& plant, Branch branch, ParticleId at, std::span<const Particle> particles,
                       std::span<const Motion> motion) {
  require(!particles.empty() && particles.size() == motion.size(),
          "a branch has particles, each with its motion");
  const BranchId id(plant.branches.size());
  branch.parent = at.valid() ? plant.particles[at.index()].branch : BranchId();
  branch.particles.clear();
  for (size_t i = 0; i < particles.size(); ++i) {
    const ParticleId self(plant.particles.size());
    plant.particles.push_back(particles[i]);
    plant.particles.back().parent = i > 0 ? branch.particles.back() : at;
    plant.particles.back().branch = id;
    plant.motion.push_back(motion[i]);
    branch.particles.push_back(self);
  }
  plant.branches.push_back(std::move(branch));
  return id;
}

TopologyChange remove_subtree(Plant& plant, ParticleId root) {
  remember_shades(plant);
  TopologyChange change;
  const std::vector<bool> gone = mark_subtree(plant, root, [](size_t) {});
  const size_t count = plant.particles.size(), branch_count = plant.branches.size();
  change.particles.resize(count);
  change.branches.resize(branch_count);

  // The branch that is cut through, and how much of it goes.
  const BranchId cut = plant.particles[root.index()].branch;
  const std::vector<ParticleId>& chain = plant.branches[cut.index()].particles;
  const auto first = std::find(chain.begin(), chain.end(), root);
  const double whole_length = length_of(plant, chain), cut_length = length_of(plant, {first, chain.end()});

  // Particles before the first that goes stay where they are.
  size_t kept = root.index();
  for (size_t i = 0; i < kept; ++i) change.particles[i] = ParticleId(i);
  for (size_t i = kept; i < count; ++i) {
    if (gone[i]) continue;
    change.particles[i] = ParticleId(kept);
    Particle& particle = plant.particles[kept] = plant.particles[i];
    if (particle.parent.valid()) particle.parent = change.particles[particle.parent.index()];
    plant.motion[kept++] = plant.motion[i];
  }
  plant.particles.resize(kept);
  plant.motion.resize(kept);

  size_t branches = 0;
  for (size_t b = 0; b < branch_count; ++b) {
    Branch& branch = plant.branches[b];
    const size_t before = branch.particles.size();
    for (ParticleId& p : branch.particles) p = change.particles[p.index()];
    std::erase(branch.particles, ParticleId());  // a chain: what goes is its end
    if (branch.particles.empty() && before > 0) continue;
    if (BranchId(b) == cut) branch.length *= 1 - cut_length / whole_length;
    change.branches[b] = BranchId(branches);
    if (branch.parent.valid()) branch.parent = change.branches[branch.parent.index()];
    if (branches != b) plant.branches[branches] = std::move(branch);
    ++branches;
  }
  plant.branches.resize(branches);
  change.shortened = change.branches[cut.index()];
  if (branches < branch_count)
    for (Particle& particle : plant.particles) particle.branch = change.branches[particle.branch.index()];

  std::erase_if(plant.anchors, [&](WorldSpring& anchor) {
    anchor.particle = change.particles[anchor.particle.index()];
    return !anchor.particle.valid();
  });
  return change;
}

Plant detach_subtree(Plant& plant, ParticleId root, TopologyChange* change, DetachedFrom* from) {
  remember_shades(plant);
  DetachedFrom origin;
  mark_subtree(plant, root, [&](size_t i) { origin.particles.push_back(ParticleId(i)); });
  Plant piece = copy_of(plant, origin.particles, origin);
  for (size_t b = 0; b < piece.branches.size(); ++b) {
    const Branch& whole = plant.branches[origin.branches[b].index()];
    if (piece.branches[b].particles.size() < whole.particles.size())
      piece.branches[b].length *=
          length_of(piece, piece.branches[b].particles) / length_of(plant, whole.particles);
  }
  let_fly(piece);
  TopologyChange moved = remove_subtree(plant, root);
  if (change) *change = std::move(moved);
  if (from) *from = std::move(origin);
  return piece;
}

void add_carried(const Plant& plant, ParticleId at, BranchId branch, double mass,
                 std::vector<double>& carried) {
  for (; at.valid(); at = plant.particles[at.index()].parent) {
    const BranchId own = plant.particles[at.index()].branch;
    if (own != branch) carried[at.index()] += mass;
    branch = own;
  }
}

double subtree_mass(const Plant& plant, ParticleId root) {
  double mass = 0;
  mark_subtree(plant, root, [&](size_t i) { mass += plant.particles[i].mass; });
  return mass;
}

}  // namespace liana
