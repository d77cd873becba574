#include "materials/pipeline/bake_job.h"

#include "materials/law/law_numbers.h"

namespace liana {

std::vector<std::string> groups_of(const SegmentedPlant& plant, const SpeciesLaw& species) {
  if (plant.domains.empty())
    throw Error(Error::Kind::Input, plant.name + ": there is no branch or leaf in it",
                "every domain is one mesh node");
  check(species, "species '" + species.species + "'");
  std::vector<std::string> groups;
  for (const Domain& domain : plant.domains)
    groups.push_back(species.group_of(domain.name, domain.kind, domain.level, domain.group));
  return groups;
}

}  // namespace liana
