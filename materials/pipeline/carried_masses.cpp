#include "materials/pipeline/carried_masses.h"

namespace liana {

std::vector<std::vector<CarriedMass>> carried_masses(const BakeJob& job,
                                                     const std::vector<DomainSolid>& solids,
                                                     const LeftOut& left_out) {
  std::vector<std::vector<CarriedMass>> carried(solids.size());
  std::vector<double> volume(solids.size(), 0);  // m³, Σ α_m V: a domain's own and all its descendants'
  for (const DomainId id : left_out.remaining())
    volume[id.index()] = solids[id.index()].material.mass_scaling * weighed_volume(solids[id.index()]);
  for (size_t index = solids.size(); index-- > 0;) {  // children before parents
    const DomainId id(index), parent = left_out.parent_of(job.plant, id);
    if (left_out.has(id) || !parent.valid()) continue;
    volume[parent.index()] += volume[index];
    const double alpha_m = solids[parent.index()].material.mass_scaling;
    carried[parent.index()].push_back(
        {solids[index].solid.root, job.species.default_material.density * volume[index] / alpha_m});
  }
  return carried;
}

}  // namespace liana
