// The stage between masses and laws: modes of every domain with what it carries.
#include <fmt/core.h>

#include "materials/cache/bake_cache.h"
#include "materials/cache/cache_entries.h"
#include "materials/pipeline/stages.h"
#include "mesher/base/parallel.h"

namespace liana {

DomainModesOptions Stages::mode_options() const {
  DomainModesOptions options;
  options.modes.element = options_.element;
  options.tets = options_.tets;
  options.threads = options_.threads;
  return options;
}

size_t Stages::bare_source(size_t index) const {
  const Piece& piece = pieces_[index];
  const size_t source = piece.instance.source;
  const bool bare = piece.carried.empty() && pieces_[source].carried.empty();
  const bool same_law = groups_[index] == groups_[source];
  return bare && same_law && is_in(DomainId(source)) ? source : index;
}

bool Stages::find_modes() {
  const std::vector<DomainId> domains = domains_in();
  const ElasticMaterial& material = species_.default_material;
  const DomainModesOptions mode_options = this->mode_options();
  const auto solid_of = [&](const Piece& piece) {
    return Solid{&piece.solid.surface,   piece.solid.is_root, piece.carried,      piece.taper,
                 piece.solid.centreline, piece.solid.volume,  piece.solid.is_beam};
  };

  std::vector<uint64_t> keys(pieces_.size(), 0);
  std::unordered_map<uint64_t, size_t> by_key;
  std::vector<size_t> missing;
  for (const DomainId id : domains) {
    const size_t i = id.index();
    if (bare_source(i) != i) continue;
    Piece& piece = pieces_[i];
    if (options_.cache && piece.geometry_key != 0) {
      keys[i] = modes_key(piece.geometry_key, solid_of(piece), material, mode_options);
      by_key.emplace(keys[i], i);
      if (recall_modes(i, by_key, keys)) continue;
    }
    missing.push_back(i);
  }

  parallel_for(missing.size(), options_.threads, [&](size_t k, unsigned) { ensure_surface(missing[k]); });
  std::vector<Solid> solids;
  for (const size_t i : missing) solids.push_back(solid_of(pieces_[i]));
  AllModes all = solve_domains(solids, material, mode_options, progress_);
  tet_seconds_ += all.tet_seconds, mode_seconds_ += all.mode_seconds;
  for (size_t k = 0; k < missing.size(); ++k) {
    const size_t i = missing[k];
    pieces_[i].modes = std::move(all.domains[k]);
    pieces_[i].modes.solved_as = missing[pieces_[i].modes.solved_as];
    const uint64_t source_key = keys[pieces_[i].modes.solved_as];
    if (keys[i] != 0 && source_key != 0)
      options_.cache->put(keys[i], encode(CachedModes{source_key, pieces_[i].modes}, material));
  }
  for (const DomainId id : domains)
    if (const size_t i = id.index(), source = bare_source(i); source != i)
      pieces_[i].modes = moved(pieces_[source].modes, pieces_[i].instance.similarity);
  for (const DomainId id : domains) judge_modes(id.index());
  refuse_failures();
  return domains_in().size() == domains.size();
}

bool Stages::recall_modes(size_t index, const std::unordered_map<uint64_t, size_t>& by_key,
                          const std::vector<uint64_t>& keys) {
  const auto bytes = options_.cache->find(keys[index]);
  if (!bytes) return false;
  CachedModes cached = decode_modes(*bytes, species_.default_material);
  const auto source = by_key.find(cached.source_key);
  if (source == by_key.end()) return false;
  pieces_[index].modes = std::move(cached.modes);
  pieces_[index].modes.solved_as = source->second;
  return true;
}

void Stages::judge_modes(size_t index) {
  Piece& piece = pieces_[index];
  const std::string& name = plant_.domains[index].name;
  if (!piece.modes.failure.empty())
    piece.failure = name + ": " + piece.modes.failure;
  else if (!piece.modes.converged)
    piece.failure =
        fmt::format("{}: its lowest mode did not converge (residual {:.1e})", name, piece.modes.residual);
}

}  // namespace liana
