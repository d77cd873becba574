#include "runtime/sim/model/topology.h"

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {
namespace {

// The particle and all that grows from it: along its branch, and every branch that grows from one of these.
std::vector<char> mark_subtree(const Plant& plant, ParticleId root) {
  std::vector<char> marked(plant.particles.size(), 0);
  const BranchId own = plant.particles[root.index()].branch;
  const auto mark_from = [&](size_t branch, ParticleId first) {
    const std::vector<ParticleId>& chain = plant.branches[branch].particles;
    for (auto p = std::lower_bound(chain.begin(), chain.end(), first); p != chain.end(); ++p)
      marked[p->index()] = 1;
  };
  mark_from(own.index(), root);
  for (size_t b = own.index() + 1; b < plant.branches.size(); ++b) {
    const std::vector<ParticleId>& chain = plant.branches[b].particles;
    if (chain.empty() || chain.front() < root) continue;
    const ParticleId at = plant.particles[chain.front().index()].parent;
    if (at.valid() && marked[at.index()]) mark_from(b, chain.front());
  }
  return marked;
}

std::vector<ParticleId> marked_ids(const std::vector<char>& marked, ParticleId root) {
  std::vector<ParticleId> ids;
  for (size_t i = root.index(); i < marked.size(); ++i)
    if (marked[i]) ids.push_back(ParticleId(i));
  return ids;
}

bool has_lineage(const Plant& plant) {
  return plant.lineage.size() == plant.particles.size();
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
    if (has_lineage(plant)) piece.lineage.push_back(plant.lineage[id.index()]);
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

// Takes the marked particles away, of which `root` is the first.
const Remap& remove_marked(Plant& plant, ParticleId root, const std::vector<char>& gone) {
  Remap change;
  const bool known = has_lineage(plant);
  const size_t count = plant.particles.size(), branch_count = plant.branches.size();
  change.particles.resize(count);
  change.branches.resize(branch_count);

  // The branch that is cut through, and how much of it goes.
  const BranchId cut = plant.particles[root.index()].branch;
  const std::vector<ParticleId>& chain = plant.branches[cut.index()].particles;
  const auto first = std::find(chain.begin(), chain.end(), root);
  const double whole_length = length_of(plant, chain), cut_length = length_of(plant, {first, chain.end()});

  size_t kept = 0;
  for (size_t i = 0; i < count; ++i)
    if (!gone[i]) change.particles[i] = ParticleId(kept++);

  // A branch is a chain with its ids ascending: what goes is its end, what stays in place its beginning.
  size_t branches = 0;
  for (size_t b = 0; b < branch_count; ++b) {
    Branch& branch = plant.branches[b];
    std::vector<ParticleId>& own = branch.particles;
    if (!own.empty() && gone[own.front().index()]) continue;
    while (!own.empty() && gone[own.back().index()]) own.pop_back();
    if (BranchId(b) == cut) branch.length *= 1 - cut_length / whole_length;
    const BranchId id = change.branches[b] = BranchId(branches++);
    if (branch.parent.valid()) branch.parent = change.branches[branch.parent.index()];
    for (auto p = own.rbegin(); p != own.rend() && root < *p; ++p) *p = change.particles[p->index()];
    if (id == BranchId(b)) continue;
    for (auto p = own.begin(); p != own.end() && *p < root; ++p) plant.particles[p->index()].branch = id;
    plant.branches[id.index()] = std::move(branch);
  }
  plant.branches.resize(branches);
  if (change(cut).valid()) change.shortened.push_back(change(cut));

  // Particles before the first that goes stay where they are.
  for (size_t i = root.index(); i < count; ++i) {
    if (gone[i]) continue;
    const size_t to = change.particles[i].index();
    Particle& particle = plant.particles[to] = plant.particles[i];
    if (particle.parent.valid()) particle.parent = change.particles[particle.parent.index()];
    particle.branch = change.branches[particle.branch.index()];
    plant.motion[to] = plant.motion[i];
    if (known) plant.lineage[to] = plant.lineage[i];
  }
  plant.lineage.resize(known ? kept : 0);
  plant.particles.resize(kept);
  plant.motion.resize(kept);

  std::erase_if(plant.anchors, [&](WorldSpring& anchor) {
    anchor.particle = change.particles[anchor.particle.index()];
    return !anchor.particle.valid();
  });
  plant.removals.add(std::move(change));
  return plant.removals.last();
}

}  // namespace

ParticleId append_particle(Plant& plant, BranchId id, const Particle& particle, const Motion& motion) {
  Branch& branch = plant.branches[id.index()];
  const ParticleId self(plant.particles.size());
  if (plant.lineage.size() == plant.particles.size() && (branch.lineage.valid() || !plant.lineage.empty()))
    plant.lineage.push_back(child_lineage(branch.lineage, LineageKind::Segment, branch.born));
  ++branch.born;
  plant.particles.push_back(particle);
  plant.particles.back().branch = id;
  plant.motion.push_back(motion);
  branch.particles.push_back(self);
  return self;
}

BranchId append_branch(Plant& plant, Branch branch, ParticleId at, std::span<const Particle> particles,
                       std::span<const Motion> motion) {
  require(!particles.empty() && particles.size() == motion.size(),
          "a branch has particles, each with its motion");
  const BranchId id(plant.branches.size());
  branch.parent = at.valid() ? plant.particles[at.index()].branch : BranchId();
  branch.particles.clear();
  branch.born = 0;
  plant.branches.push_back(std::move(branch));
  for (size_t i = 0; i < particles.size(); ++i) {
    Particle particle = particles[i];
    particle.parent = i > 0 ? plant.branches.back().particles.back() : at;
    append_particle(plant, id, particle, motion[i]);
  }
  return id;
}

const Remap& remove_subtree(Plant& plant, ParticleId root) {
  remember_shades(plant);
  return remove_marked(plant, root, mark_subtree(plant, root));
}

Plant detach_subtree(Plant& plant, ParticleId root, Remap* change, DetachedFrom* from) {
  remember_shades(plant);
  const std::vector<char> marked = mark_subtree(plant, root);
  DetachedFrom origin;
  origin.particles = marked_ids(marked, root);
  Plant piece = copy_of(plant, origin.particles, origin);
  for (size_t b = 0; b < piece.branches.size(); ++b) {
    const Branch& whole = plant.branches[origin.branches[b].index()];
    if (piece.branches[b].particles.size() < whole.particles.size())
      piece.branches[b].length *=
          length_of(piece, piece.branches[b].particles) / length_of(plant, whole.particles);
  }
  let_fly(piece);
  const Remap& moved = remove_marked(plant, root, marked);
  if (change) *change = moved;
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
  for (const ParticleId id : marked_ids(mark_subtree(plant, root), root))
    mass += plant.particles[id.index()].mass;
  return mass;
}

}  // namespace liana
