#include "materials/pipeline/recall_solids.h"

#include <algorithm>
#include <unordered_map>

#include "materials/cache/bake_cache.h"
#include "materials/cache/cache_entries.h"

namespace liana {
namespace {

bool is_copy(const std::vector<DomainSolid>& solids, size_t index) {
  return solids[index].instance.source != index;
}

void recall_from(BakeCache& cache, std::vector<DomainSolid>& solids) {
  std::unordered_map<uint64_t, size_t> first;  // domain of a key
  for (size_t i = 0; i < solids.size(); ++i) {
    DomainSolid& domain = solids[i];
    if (!first.emplace(domain.cache_key, i).second) {
      domain.cache_key = 0;  // the same surface in the same place twice: only the first is kept
      continue;
    }
    const auto bytes = cache.find(domain.cache_key);
    if (!bytes) continue;
    auto content = decode_geometry(*bytes);
    if (auto* solid = std::get_if<SolidDomain>(&content)) {
      domain.solid = std::move(*solid);
      domain.from_cache = true;
      continue;
    }
    const CachedCopy& copy = std::get<CachedCopy>(content);
    const auto source = first.find(copy.source_key);
    if (source == first.end() || !solids[source->second].from_cache || is_copy(solids, source->second))
      continue;
    domain.instance = {source->second, copy.similarity};
    domain.from_cache = true;
  }
}

void find_copies(const SegmentedPlant& plant, std::vector<DomainSolid>& solids) {
  const std::vector<Instance> instances = find_instances(plant);
  for (size_t i = 0; i < solids.size(); ++i)
    if (!solids[i].from_cache) solids[i].instance = instances[i];
  // Copies of what the cache knows as a copy itself are made on their own.
  for (size_t i = 0; i < solids.size(); ++i)
    if (is_copy(solids, i) && is_copy(solids, solids[i].instance.source)) {
      solids[i].instance = {i, {}};
      solids[i].from_cache = false;
    }
}

}  // namespace

std::vector<DomainSolid> recall_solids(const BakeJob& job) {
  std::vector<DomainSolid> solids(job.plant.domains.size());
  for (size_t i = 0; i < solids.size(); ++i) solids[i].instance = {i, {}};
  if (job.options.cache) {
    const std::vector<uint64_t> keys = geometry_keys(job.plant);
    for (size_t i = 0; i < solids.size(); ++i) solids[i].cache_key = keys[i];
    recall_from(*job.options.cache, solids);
  }
  if (!std::all_of(solids.begin(), solids.end(), [](const DomainSolid& d) { return d.from_cache; }))
    find_copies(job.plant, solids);
  return solids;
}

void remember_solids(const BakeJob& job, const std::vector<DomainSolid>& solids) {
  if (!job.options.cache) return;
  const LeftOut left_out = failures_of(solids);
  std::vector<uint8_t> carries(solids.size(), 0);
  for (const DomainId id : left_out.remaining())
    if (const DomainId parent = left_out.parent_of(job.plant, id); parent.valid())
      carries[parent.index()] = 1;
  for (const DomainId id : left_out.remaining()) {
    const DomainSolid& domain = solids[id.index()];
    if (domain.from_cache || domain.cache_key == 0) continue;
    const uint64_t source_key = solids[domain.instance.source].cache_key;
    if (!is_copy(solids, id.index()))
      job.options.cache->put(domain.cache_key, encode(domain.solid, carries[id.index()]));
    else if (source_key != 0)
      job.options.cache->put(domain.cache_key, encode(CachedCopy{source_key, domain.instance.similarity}));
  }
}

}  // namespace liana
