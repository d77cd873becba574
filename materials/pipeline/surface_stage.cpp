// The stages before the laws are known: every domain made solid, once for each shape.
#include <algorithm>

#include "materials/cache/bake_cache.h"
#include "materials/cache/cache_entries.h"
#include "materials/law/power_law.h"
#include "materials/pipeline/stages.h"
#include "mesher/base/parallel.h"

namespace liana {

void Stages::make_surfaces() {
  progress_.begin("surface", pieces_.size());
  recall_surfaces();
  std::vector<size_t> firsts, copies;
  for (size_t i = 0; i < pieces_.size(); ++i) (is_copy(i) ? copies : firsts).push_back(i);
  const auto in_parallel = [&](const std::vector<size_t>& indices, void (Stages::*work)(size_t)) {
    parallel_for(indices.size(), options_.threads, [&](size_t k, unsigned) {
      progress_.throw_if_cancelled();
      Piece& piece = pieces_[indices[k]];
      try {
        (this->*work)(indices[k]);
        const GroupLaw& law = species_.group(groups_[indices[k]]);
        piece.material = evaluate(law, piece.solid.length);
        piece.taper = law.taper;
      } catch (const Error& error) {
        if (error.kind != Error::Kind::Input) throw;
        piece.failure = error.what();
      }
      progress_.advance();
    });
  };
  in_parallel(firsts, &Stages::make_surface);
  in_parallel(copies, &Stages::copy_surface);
  refuse_failures();
  remember_surfaces();
}

void Stages::make_surface(size_t index) {
  if (!pieces_[index].from_cache) pieces_[index].solid = make_solid(plant_, DomainId(index));
}

/// The source's solid, moved; made anew where the copy hangs on its parent by another end.
void Stages::copy_surface(size_t index) {
  Piece& piece = pieces_[index];
  const auto& [source, similarity] = piece.instance;
  const Piece& original = pieces_[source];
  if (original.failure.empty() &&
      (piece.from_cache ||
       attached_alike(plant_, DomainId(source), original.solid, DomainId(index), similarity))) {
    piece.solid = moved(original.solid, similarity);
    return;
  }
  piece.instance = {index, {}};
  piece.solid = make_solid(plant_, DomainId(index));
}

/// Fills the pieces that the cache knows, and finds copies among the rest.
void Stages::recall_surfaces() {
  if (options_.cache) {
    const std::vector<uint64_t> keys = geometry_keys(plant_);
    for (size_t i = 0; i < pieces_.size(); ++i) pieces_[i].geometry_key = keys[i];
    recall_copies();
    const auto known = [](const Piece& piece) { return piece.from_cache; };
    if (std::all_of(pieces_.begin(), pieces_.end(), known)) return;
  }
  const std::vector<Instance> instances = find_instances(plant_);
  for (size_t i = 0; i < pieces_.size(); ++i)
    if (!pieces_[i].from_cache) pieces_[i].instance = instances[i];
  // Copies of what the cache knows as a copy itself are made on their own.
  for (size_t i = 0; i < pieces_.size(); ++i)
    if (is_copy(i) && is_copy(pieces_[i].instance.source)) {
      pieces_[i].instance = {i, {}};
      pieces_[i].from_cache = false;
    }
}

void Stages::recall_copies() {
  std::unordered_map<uint64_t, size_t> first;  // domain of a key
  for (size_t i = 0; i < pieces_.size(); ++i) {
    Piece& piece = pieces_[i];
    if (!first.emplace(piece.geometry_key, i).second) {
      piece.geometry_key = 0;  // the same surface in the same place twice: only the first is kept
      continue;
    }
    const auto bytes = options_.cache->find(piece.geometry_key);
    if (!bytes) continue;
    auto content = decode_geometry(*bytes);
    if (auto* solid = std::get_if<SolidDomain>(&content)) {
      piece.solid = std::move(*solid);
      piece.from_cache = true;
      continue;
    }
    const CachedCopy& copy = std::get<CachedCopy>(content);
    const auto source = first.find(copy.source_key);
    if (source == first.end() || !pieces_[source->second].from_cache || is_copy(source->second)) continue;
    piece.instance = {source->second, copy.similarity};
    piece.from_cache = true;
  }
}

void Stages::remember_surfaces() {
  if (!options_.cache) return;
  std::vector<uint8_t> carries(pieces_.size(), 0);
  for (const DomainId id : domains_in())
    if (const DomainId parent = parent_of(id); parent.valid()) carries[parent.index()] = 1;
  for (const DomainId id : domains_in()) {
    const Piece& piece = pieces_[id.index()];
    if (piece.from_cache || piece.geometry_key == 0) continue;
    const size_t source = piece.instance.source;
    if (!is_copy(id.index()))
      options_.cache->put(piece.geometry_key, encode(piece.solid, carries[id.index()]));
    else if (pieces_[source].geometry_key != 0)
      options_.cache->put(piece.geometry_key,
                          encode(CachedCopy{pieces_[source].geometry_key, piece.instance.similarity}));
  }
}

/// What came from the cache has a surface only where modes are likely to be found again.
void Stages::ensure_surface(size_t index) {
  Piece& piece = pieces_[index];
  if (!piece.solid.surface.triangles.empty()) return;
  const auto& [source, similarity] = piece.instance;
  if (source == index)
    piece.solid = make_solid(plant_, DomainId(index));
  else
    piece.solid = moved(make_solid(plant_, DomainId(source)), similarity);
}

}  // namespace liana
