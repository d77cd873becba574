#include "mesher/solids/unions/merge_domains.h"

#include <fmt/core.h>

#include <cmath>

#include "mesher/base/parallel.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/exact/solid_union.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {
namespace {

class Merging {
 public:
  Merging(const SegmentedPlant& plant, int level) : plant_(plant), part_of_(plant.domains.size()) {
    for (size_t i = 0; i < plant.domains.size(); ++i) {
      const Domain& domain = plant.domains[i];
      const bool merges = domain.kind == DomainKind::Branch && domain.level > level &&
                          domain.parent.valid() &&
                          plant.domains[domain.parent.index()].kind == DomainKind::Branch;
      part_of_[i] = merges ? part_of_[domain.parent.index()] : DomainId(i);
    }
  }

  /// The domains that are to become one with `keeper`, parents first, itself left out.
  std::vector<std::vector<DomainId>> parts() const {
    std::vector<std::vector<DomainId>> parts(part_of_.size());
    for (size_t i = 0; i < part_of_.size(); ++i)
      if (part_of_[i] != DomainId(i)) parts[part_of_[i].index()].push_back(DomainId(i));
    return parts;
  }

  /// The union of a keeper and its parts; those that do not join become keepers, with what grows on them.
  Mesh unite(DomainId keeper, const std::vector<DomainId>& parts) {
    const SolidDomain solid = make_solid(plant_, keeper);
    if (solid.is_beam) {
      leave_apart(parts);
      return plant_.domains[keeper.index()].surface;
    }
    SolidUnion all(solid.surface);
    size_t joined = 0;
    for (const DomainId part : parts) {
      const DomainId on = part_of_[plant_.domains[part.index()].parent.index()];
      if (on == keeper && joins(all, part))
        ++joined;
      else
        part_of_[part.index()] = on == keeper ? part : on;
    }
    if (joined == 0) return plant_.domains[keeper.index()].surface;
    // Of a branch's thickness, √(V / ℓ): far below what the tetrahedra resolve, but twigs are thinner.
    const double thickness = std::sqrt(solid.volume / solid.length);
    for (const bool as_it_is : {true, false})
      for (const double share : {0.003, 0.001, 0.0001}) {
        Mesh mesh = all.mesh(share * thickness);
        if (can_be_solid(keeper, mesh, as_it_is)) return mesh;
      }
    throw Error(Error::Kind::Input,
                "the union of '" + plant_.domains[keeper.index()].name + "' cannot be made solid");
  }

  void leave_apart(const std::vector<DomainId>& parts) {
    for (const DomainId part : parts) part_of_[part.index()] = part;
  }

  const std::vector<DomainId>& part_of() const { return part_of_; }

 private:
  /// Whether the bake's own steps accept the union, where its branch grows: as it is, or mended.
  bool can_be_solid(DomainId keeper, const Mesh& mesh, bool as_it_is) const {
    if (as_it_is && self_intersects(mesh)) return false;
    SegmentedPlant pair;
    Domain domain = plant_.domains[keeper.index()];
    if (domain.parent.valid()) {
      pair.domains.push_back(plant_.domains[domain.parent.index()]);
      pair.domains[0].parent = DomainId();
      domain.parent = DomainId(size_t{0});
    }
    domain.surface = mesh;
    pair.domains.push_back(std::move(domain));
    try {
      return !make_solid(pair, DomainId(pair.domains.size() - 1)).is_beam;
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Input) throw;
      return false;
    }
  }

  bool joins(SolidUnion& all, DomainId part) const {
    try {
      const SolidDomain solid = make_solid(plant_, part);
      return !solid.is_beam && all.add(solid.surface);
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Input) throw;
      return false;  // it cannot be made solid: on its own the bake says why
    }
  }

  const SegmentedPlant& plant_;
  std::vector<DomainId> part_of_;  ///< of the plant before
};

}  // namespace

MergedPlant merge_below(const SegmentedPlant& plant, int level, unsigned threads, Progress& progress) {
  Merging merging(plant, level);
  const std::vector<DomainId> wanted = merging.part_of();
  const std::vector<std::vector<DomainId>> parts = merging.parts();
  std::vector<Mesh> surfaces(plant.domains.size());
  progress.begin("merge", plant.domains.size());
  parallel_for(plant.domains.size(), threads, [&](size_t i, unsigned) {
    progress.throw_if_cancelled();
    progress.advance();
    surfaces[i] = plant.domains[i].surface;
    if (parts[i].empty()) return;
    try {
      surfaces[i] = merging.unite(DomainId(i), parts[i]);
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Input) throw;
      merging.leave_apart(parts[i]);  // they stay domains of their own, and are named
    }
  });

  MergedPlant result{{plant.name, {}, {}, plant.source_hash}, std::vector<DomainId>(plant.domains.size())};
  std::vector<std::string>& notes = result.plant.notes;
  size_t merged = 0;
  for (size_t i = 0; i < plant.domains.size(); ++i) {
    const DomainId keeper = merging.part_of()[i];
    if (keeper != DomainId(i)) {
      result.became[i] = result.became[keeper.index()];
      ++merged;
      continue;
    }
    result.became[i] = DomainId(result.plant.domains.size());
    Domain domain = plant.domains[i];
    domain.surface = std::move(surfaces[i]);
    if (domain.parent.valid()) {
      domain.parent = result.became[domain.parent.index()];
      domain.level = result.plant.domains[domain.parent.index()].level + 1;
    }
    result.plant.domains.push_back(std::move(domain));
    if (wanted[i] != keeper)
      notes.push_back(fmt::format("'{}' cannot be united with what it grows on: it stays a domain of its own",
                                  plant.domains[i].name));
  }
  notes.insert(notes.begin(),
               fmt::format("merged below level {}: {} branches became part of another, {} domains are left",
                           level, merged, result.plant.domains.size()));
  notes.insert(notes.begin(), plant.notes.begin(), plant.notes.end());
  return result;
}

}  // namespace liana
