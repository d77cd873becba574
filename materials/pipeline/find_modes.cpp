#include "materials/pipeline/find_modes.h"

#include <fmt/core.h>

#include <unordered_map>

#include "materials/cache/bake_cache.h"
#include "materials/cache/cache_entries.h"
#include "mesher/base/parallel.h"

namespace liana {
namespace {

class ModeFinder {
 public:
  ModeFinder(const BakeJob& job, const std::vector<DomainSolid>& solids,
             const std::vector<std::vector<CarriedMass>>& carried, const LeftOut& left_out)
      : job_(job), solids_(solids), carried_(carried), left_out_(left_out), keys_(solids.size(), 0) {
    options_.modes.element = job.options.element;
    options_.tets = job.options.tets;
    options_.threads = job.options.threads;
    found_.modes.resize(solids.size()), found_.failures.resize(solids.size());
  }

  FoundModes find() {
    const std::vector<DomainId> domains = left_out_.remaining();
    solve(recall(domains));
    for (const DomainId id : domains)
      if (const size_t i = id.index(), source = bare_source(i); source != i)
        found_.modes[i] = moved(found_.modes[source], solids_[i].instance.similarity);
    for (const DomainId id : domains) found_.failures[id.index()] = failure_of(id.index());
    return std::move(found_);
  }

 private:
  /// The domain whose modes it takes because it is its copy and neither carries anything; else itself.
  size_t bare_source(size_t index) const {
    const size_t source = solids_[index].instance.source;
    const bool bare = carried_[index].empty() && carried_[source].empty();
    const bool same_law = job_.groups[index] == job_.groups[source];
    return bare && same_law && !left_out_.has(DomainId(source)) ? source : index;
  }

  Solid to_solve(size_t index, const SolidDomain& solid) const {
    return {&solid.surface,   solid.is_root, carried_[index], solids_[index].taper,
            solid.centreline, solid.volume,  solid.is_beam};
  }

  /// Takes modes from the cache. Returns the domains that have to be solved.
  std::vector<size_t> recall(const std::vector<DomainId>& domains) {
    std::unordered_map<uint64_t, size_t> by_key;
    std::vector<size_t> missing;
    for (const DomainId id : domains) {
      const size_t i = id.index();
      if (bare_source(i) != i) continue;
      if (job_.options.cache && solids_[i].cache_key != 0) {
        keys_[i] = modes_key(solids_[i].cache_key, to_solve(i, solids_[i].solid),
                             job_.species.default_material, options_);
        by_key.emplace(keys_[i], i);
        if (recall_one(i, by_key)) continue;
      }
      missing.push_back(i);
    }
    return missing;
  }

  bool recall_one(size_t index, const std::unordered_map<uint64_t, size_t>& by_key) {
    const auto bytes = job_.options.cache->find(keys_[index]);
    if (!bytes) return false;
    CachedModes cached = decode_modes(*bytes, job_.species.default_material);
    const auto source = by_key.find(cached.source_key);
    if (source == by_key.end()) return false;
    found_.modes[index] = std::move(cached.modes);
    found_.modes[index].solved_as = source->second;
    return true;
  }

  void solve(const std::vector<size_t>& missing) {
    std::vector<std::optional<SolidDomain>> made(missing.size());
    parallel_for(missing.size(), options_.threads,
                 [&](size_t k, unsigned) { made[k] = missing_surface(job_, solids_, missing[k]); });
    std::vector<Solid> to_solve;
    for (size_t k = 0; k < missing.size(); ++k)
      to_solve.push_back(this->to_solve(missing[k], made[k] ? *made[k] : solids_[missing[k]].solid));
    const ElasticMaterial& material = job_.species.default_material;
    AllModes all = solve_domains(to_solve, material, options_, job_.progress);
    found_.tet_seconds = all.tet_seconds, found_.mode_seconds = all.mode_seconds;
    for (size_t k = 0; k < missing.size(); ++k) {
      const size_t i = missing[k];
      DomainModes& modes = found_.modes[i];
      modes = std::move(all.domains[k]);
      modes.solved_as = missing[modes.solved_as];
      if (const uint64_t source_key = keys_[modes.solved_as]; keys_[i] != 0 && source_key != 0)
        job_.options.cache->put(keys_[i], encode(CachedModes{source_key, modes}, material));
    }
  }

  std::string failure_of(size_t index) const {
    const DomainModes& modes = found_.modes[index];
    const std::string& name = job_.plant.domains[index].name;
    if (!modes.failure.empty()) return name + ": " + modes.failure;
    if (!modes.converged)
      return fmt::format("{}: its lowest mode did not converge (residual {:.1e})", name, modes.residual);
    return {};
  }

  const BakeJob& job_;
  const std::vector<DomainSolid>& solids_;
  const std::vector<std::vector<CarriedMass>>& carried_;
  const LeftOut& left_out_;
  DomainModesOptions options_;
  std::vector<uint64_t> keys_;  // in the cache, of what is solved
  FoundModes found_;
};

}  // namespace

FoundModes find_modes(const BakeJob& job, const std::vector<DomainSolid>& solids,
                      const std::vector<std::vector<CarriedMass>>& carried, const LeftOut& left_out) {
  return ModeFinder(job, solids, carried, left_out).find();
}

}  // namespace liana
