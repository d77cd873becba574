#include "materials/pipeline/domain_solids.h"

#include "materials/law/power_law.h"
#include "materials/pipeline/recall_solids.h"
#include "materials/pipeline/stations.h"
#include "mesher/base/parallel.h"

namespace liana {
namespace {

/// The source's solid, moved; made anew where the copy hangs on its parent by another end.
void copy_solid(const BakeJob& job, const DomainSolid& original, size_t index, DomainSolid& copy) {
  const DomainId source(copy.instance.source), id(index);
  if (original.failure.empty() &&
      (copy.from_cache || attached_alike(job.plant, source, original.solid, id, copy.instance.similarity))) {
    copy.solid = moved(original.solid, copy.instance.similarity);
    return;
  }
  copy.instance = {index, {}};
  copy.solid = make_solid(job.plant, id);
}

}  // namespace

std::vector<DomainSolid> make_solids(const BakeJob& job) {
  job.progress.begin("surface", job.plant.domains.size());
  std::vector<DomainSolid> solids = recall_solids(job);
  std::vector<size_t> firsts, copies;
  for (size_t i = 0; i < solids.size(); ++i) (solids[i].instance.source == i ? firsts : copies).push_back(i);

  const auto in_parallel = [&](const std::vector<size_t>& indices, const auto& make) {
    parallel_for(indices.size(), job.options.threads, [&](size_t k, unsigned) {
      job.progress.throw_if_cancelled();
      DomainSolid& domain = solids[indices[k]];
      try {
        make(indices[k], domain);
        const GroupLaw& law = job.species.group(job.groups[indices[k]]);
        domain.material = evaluate(law, domain.solid.length);
        domain.taper = law.taper;
      } catch (const Error& error) {
        if (error.kind != Error::Kind::Input) throw;
        domain.failure = error.what();
      }
      job.progress.advance();
    });
  };
  in_parallel(firsts, [&](size_t index, DomainSolid& domain) {
    if (!domain.from_cache) domain.solid = make_solid(job.plant, DomainId(index));
  });
  in_parallel(copies, [&](size_t index, DomainSolid& domain) {
    copy_solid(job, solids[domain.instance.source], index, domain);
  });
  remember_solids(job, solids);
  return solids;
}

LeftOut failures_of(const std::vector<DomainSolid>& solids) {
  std::vector<std::string> failures;
  for (const DomainSolid& domain : solids) failures.push_back(domain.failure);
  LeftOut left_out(solids.size());
  left_out.add(failures);
  return left_out;
}

std::optional<SolidDomain> missing_surface(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                           size_t index) {
  if (!solids[index].solid.surface.triangles.empty()) return {};
  const auto& [source, similarity] = solids[index].instance;
  const SolidDomain made = make_solid(job.plant, DomainId(source));
  return source == index ? made : moved(made, similarity);
}

double weighed_volume(const DomainSolid& domain) {
  return mean_taper(domain.solid.centreline, domain.taper) * domain.solid.volume;
}

}  // namespace liana
