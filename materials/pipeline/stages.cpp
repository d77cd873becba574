#include "materials/pipeline/stages.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "materials/law/damping.h"
#include "materials/law/law_numbers.h"
#include "materials/law/material_model.h"
#include "materials/law/power_law.h"
#include "materials/pipeline/stations.h"

namespace liana {

Stages::Stages(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
               Progress& progress)
    : plant_(plant),
      species_(species),
      options_(options),
      progress_(progress),
      pieces_(plant.domains.size()) {
  for (size_t i = 0; i < pieces_.size(); ++i) pieces_[i].instance = {i, {}};
  if (plant.domains.empty())
    throw Error(Error::Kind::Input, plant.name + ": there is no branch or leaf in it",
                "every domain is one mesh node");
  check(species, "species '" + species.species + "'");
  for (const Domain& domain : plant.domains)  // throws for a domain without a law
    groups_.push_back(species.group_of(domain.name, domain.kind, domain.level, domain.group));
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

double Stages::weighed_volume(const Piece& piece) const {
  return mean_taper(piece.solid.centreline, piece.taper) * piece.solid.volume;
}

double Stages::own_mass(const Piece& piece) const {
  return piece.material.mass_scaling * species_.default_material.density * weighed_volume(piece);
}

void Stages::carry_descendants() {
  for (Piece& piece : pieces_)
    piece.carried.clear(), piece.subtree_volume = piece.material.mass_scaling * weighed_volume(piece);
  for (size_t index = pieces_.size(); index-- > 0;) {  // children before parents
    const DomainId id(index), parent = parent_of(id);
    if (!is_in(id) || !parent.valid()) continue;
    Piece &piece = pieces_[index], &below = pieces_[parent.index()];
    below.subtree_volume += piece.subtree_volume;
    below.carried.push_back({piece.solid.root, species_.default_material.density * piece.subtree_volume /
                                                   below.material.mass_scaling});
  }
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
          .group = groups_[id.index()],
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

void Stages::choose_frequencies() {
  if (species_.model.model == MaterialModel::PowerLaw) return;
  const std::vector<DomainId> domains = domains_in();
  std::vector<ModelledDomain> modelled;
  for (const DomainId id : domains) {
    const Domain& domain = plant_.domains[id.index()];
    const Piece& piece = pieces_[id.index()];
    modelled.push_back({groups_[id.index()], domain.kind, domain.level, piece.solid.length,
                        piece.modes.frequencies.front()});
  }
  ModelFrequencies chosen = model_frequencies(species_, modelled);
  model_notes_ = std::move(chosen.notes);
  for (size_t i = 0; i < domains.size(); ++i)
    pieces_[domains[i].index()].material =
        evaluate_at(species_.group(modelled[i].group), modelled[i].length, chosen.frequencies[i]);
}

Bake Stages::apply_laws() {
  progress_.begin("laws", pieces_.size());
  choose_frequencies();
  Bake bake;
  bake.plant = plant_.name, bake.plant_hash = plant_.source_hash, bake.law = species_;
  std::vector<DomainId>& new_id = baked_as_;
  new_id.assign(pieces_.size(), {});  // ids count the domains that stayed
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

std::string Stages::describe_losses() const {
  constexpr double kNothing = 1e-6;
  std::vector<std::pair<double, size_t>> losses;
  for (const DomainId id : domains_in())
    if (const SolidDomain& solid = pieces_[id.index()].solid;
        std::max(solid.lost_area, solid.lost_volume) > kNothing)
      losses.push_back({solid.lost_area, id.index()});
  if (losses.empty()) return {};
  std::sort(losses.rbegin(), losses.rend());
  constexpr size_t kNamed = 5;
  std::string names;
  for (size_t i = 0; i < std::min(kNamed, losses.size()); ++i) {
    const auto& [area, index] = losses[i];
    names += fmt::format("{}'{}' {:.2g} % of its area and {:.2g} % of its volume", i ? ", " : "",
                         name_of(DomainId(index)), 100 * area, 100 * pieces_[index].solid.lost_volume);
  }
  return fmt::format("{} {} something when mended: {}{}", losses.size(),
                     losses.size() == 1 ? "domain lost" : "domains lost", names,
                     losses.size() > kNamed ? ", ..." : "");
}

std::vector<std::string> Stages::notes() const {
  const std::set<std::string> used(groups_.begin(), groups_.end());
  std::vector<std::string> notes = model_notes_;
  if (const std::string lost = describe_losses(); !lost.empty()) notes.push_back(lost);
  const auto rough = std::count_if(pieces_.begin(), pieces_.end(), [](const Piece& piece) {
    return piece.failure.empty() &&
           (piece.solid.route + piece.modes.note).find("rough-beam") != std::string::npos;
  });
  if (rough)
    notes.push_back(fmt::format(
        "{} wide or folded sheets could only be solved as rough beams (route): their default frequencies "
        "may be far off",
        rough));
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
