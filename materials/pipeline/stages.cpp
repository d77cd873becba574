#include "materials/pipeline/stages.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "materials/law/damping.h"
#include "materials/law/law_numbers.h"
#include "materials/law/power_law.h"
#include "materials/pipeline/stations.h"
#include "mesher/base/parallel.h"

namespace liana {

Stages::Stages(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
               Progress& progress)
    : plant_(plant),
      species_(species),
      options_(options),
      progress_(progress),
      pieces_(plant.domains.size()) {
  if (plant.domains.empty())
    throw Error(Error::Kind::Input, plant.name + ": there is no branch or leaf in it",
                "every domain is one mesh node");
  check(species, "species '" + species.species + "'");
  for (const Domain& domain : plant.domains) species.group(domain.group);  // throws for a group without a law
}

std::vector<DomainId> Stages::domains_in() const {
  std::vector<DomainId> domains;
  for (size_t index = 0; index < pieces_.size(); ++index)
    if (is_in(DomainId(index))) domains.push_back(DomainId(index));
  return domains;
}

void Stages::refuse_failures() const {
  const auto failed =
      std::find_if(pieces_.begin(), pieces_.end(), [](const Piece& p) { return !p.failure.empty(); });
  if (failed != pieces_.end() && options_.strict)
    throw Error(Error::Kind::Input, plant_.name + ": " + failed->failure,
                "mend this domain, or leave out --strict to bake the others");
  if (domains_in().empty())
    throw Error(Error::Kind::Input,
                fmt::format("{}: none of its {} domains could be baked; the first: {}", plant_.name,
                            pieces_.size(), pieces_.front().failure),
                "look at it with: liana inspect FILE");
}

DomainId Stages::parent_of(DomainId domain) const {
  DomainId parent = plant_.domains[domain.index()].parent;
  while (parent.valid() && !is_in(parent)) parent = plant_.domains[parent.index()].parent;
  return parent;
}

void Stages::make_surfaces() {
  progress_.begin("surface", pieces_.size());
  parallel_for(pieces_.size(), options_.threads, [&](size_t index, unsigned) {
    progress_.throw_if_cancelled();
    Piece& piece = pieces_[index];
    try {
      piece.solid = make_solid(plant_, DomainId(index));
      piece.material = evaluate(species_.group(plant_.domains[index].group), piece.solid.length);
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Input) throw;
      piece.failure = error.what();
    }
    progress_.advance();
  });
  refuse_failures();
}

double Stages::own_mass(const Piece& piece) const {
  return piece.material.mass_scaling * species_.default_material.density * piece.solid.volume;
}

void Stages::carry_descendants() {
  for (Piece& piece : pieces_) piece.carried.clear(), piece.subtree_mass = own_mass(piece);
  for (size_t index = pieces_.size(); index-- > 0;) {  // children before parents
    const DomainId id(index), parent = parent_of(id);
    if (!is_in(id) || !parent.valid()) continue;
    Piece &piece = pieces_[index], &below = pieces_[parent.index()];
    below.subtree_mass += piece.subtree_mass;
    below.carried.push_back({piece.solid.root, piece.subtree_mass / below.material.mass_scaling});
  }
}

bool Stages::find_modes() {
  const std::vector<DomainId> domains = domains_in();
  std::vector<Solid> solids;
  for (const DomainId id : domains) {
    const Piece& piece = pieces_[id.index()];
    solids.push_back({&piece.solid.surface, piece.solid.is_root, piece.carried, piece.solid.centreline,
                      piece.solid.volume, piece.solid.is_beam});
  }
  DomainModesOptions mode_options;
  mode_options.modes.element = options_.element;
  mode_options.tets = options_.tets;
  mode_options.threads = options_.threads;
  AllModes all = solve_domains(solids, species_.default_material, mode_options, progress_);
  tet_seconds_ += all.tet_seconds, mode_seconds_ += all.mode_seconds;

  for (size_t i = 0; i < domains.size(); ++i) {
    Piece& piece = pieces_[domains[i].index()];
    piece.modes = std::move(all.domains[i]);
    piece.modes.solved_as = domains[piece.modes.solved_as].index();
    if (!piece.modes.failure.empty())
      piece.failure = name_of(domains[i]) + ": " + piece.modes.failure;
    else if (!piece.modes.converged)
      piece.failure = fmt::format("{}: its lowest mode did not converge (residual {:.1e})",
                                  name_of(domains[i]), piece.modes.residual);
  }
  refuse_failures();
  return domains_in().size() == domains.size();
}

BakedDomain Stages::baked(DomainId id) const {
  const Domain& domain = plant_.domains[id.index()];
  const Piece& piece = pieces_[id.index()];
  const Sway& sway = piece.modes.sway;
  const double default_frequency = piece.modes.frequencies.front(), alpha_m = piece.material.mass_scaling;
  const double alpha_k = stiffness_scaling(alpha_m, piece.material.frequency, default_frequency);
  const double ratio = sway.frequencies[1] / sway.frequencies[0];
  const Vec3 normal = flat_normal(piece.solid.centreline, sway.directions[0]);
  return {.name = domain.name,
          .parent = parent_of(id),
          .kind = domain.kind,
          .level = domain.level,
          .group = domain.group,
          .length = piece.solid.length,
          .mass = own_mass(piece),
          .tets = piece.modes.tets,
          .dof = piece.modes.dof,
          .default_frequency = default_frequency,
          .material = piece.material,
          .stiffness_scaling = alpha_k,
          .youngs_modulus = alpha_k * species_.default_material.youngs_modulus,
          .density = alpha_m * species_.default_material.density,
          .route = piece.solid.route + piece.modes.note,
          .solved_as = DomainId(piece.modes.solved_as),
          .centreline = stations(piece.solid.centreline, normal),
          .flat_normal = normal,
          .stiffness_ratio = ratio * ratio};
}

Bake Stages::apply_laws() const {
  progress_.begin("laws", pieces_.size());
  Bake bake;
  bake.plant = plant_.name, bake.plant_hash = plant_.source_hash, bake.law = species_;
  std::vector<DomainId> new_id(pieces_.size());  // ids count the domains that stayed
  for (size_t index = 0; index < pieces_.size(); ++index) {
    const DomainId old_id(index);
    progress_.advance();
    if (!is_in(old_id)) {
      bake.failed.push_back(describe_failure(old_id));
      continue;
    }
    new_id[index] = DomainId(bake.domains.size());
    BakedDomain domain = baked(old_id);
    if (domain.parent.valid()) domain.parent = new_id[domain.parent.index()];
    domain.solved_as = new_id[domain.solved_as.index()];
    bake.domains.push_back(std::move(domain));
  }
  return bake;
}

std::string Stages::describe_failure(DomainId id) const {
  const auto children = std::count_if(plant_.domains.begin(), plant_.domains.end(),
                                      [&](const Domain& domain) { return domain.parent == id; });
  std::string text = pieces_[id.index()].failure;
  if (children == 0) return text;
  const DomainId parent = parent_of(id);
  const std::string to = parent.valid() ? "'" + name_of(parent) + "'" : "the ground";
  return text + fmt::format("; what grew on it ({}) now attaches to {}", children, to);
}

std::vector<std::string> Stages::notes() const {
  std::set<std::string> used;
  for (const Domain& domain : plant_.domains) used.insert(domain.group);
  std::vector<std::string> notes;
  for (const std::string& group : used) {
    const DampingLaw& damping = species_.group(group).damping;
    if (!species_.groups.contains(group))
      notes.push_back(fmt::format("{} has no law of its own in '{}': it takes that of the level above it",
                                  group, species_.species));
    if (!is_monotonic(damping))
      notes.push_back(
          fmt::format("{}: with delta {} and kappa {} damping first falls, then rises as it stiffens", group,
                      damping.delta, damping.kappa));
  }
  return notes;
}

}  // namespace liana
