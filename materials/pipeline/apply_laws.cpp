#include "materials/pipeline/apply_laws.h"

#include "materials/law/material_model.h"
#include "materials/law/power_law.h"
#include "materials/pipeline/stations.h"

namespace liana {
namespace {

/// But for parent and solved_as, which are ids.
BakedDomain baked(const BakeJob& job, size_t index, const DomainSolid& made, const DomainModes& modes,
                  const DomainMaterial& material) {
  const Domain& domain = job.plant.domains[index];
  const ElasticMaterial& unscaled = job.species.default_material;
  const double default_frequency = modes.frequencies.front(), alpha_m = material.mass_scaling;
  const double alpha_k = stiffness_scaling(alpha_m, material.frequency, default_frequency);
  const double ratio = modes.sway.frequencies[1] / modes.sway.frequencies[0];
  const Vec3 normal = flat_normal(made.solid.centreline, modes.sway.directions[0]);
  return {.name = domain.name,
          .parent = {},
          .kind = domain.kind,
          .level = domain.level,
          .group = job.groups[index],
          .length = made.solid.length,
          .mass = alpha_m * unscaled.density * weighed_volume(made),
          .tets = modes.tets,
          .dof = modes.dof,
          .default_frequency = default_frequency,
          .material = material,
          .stiffness_scaling = alpha_k,
          .youngs_modulus = alpha_k * unscaled.youngs_modulus,
          .density = alpha_m * unscaled.density,
          .route = made.solid.route + modes.note,
          .solved_as = {},
          .centreline = stations(made.solid.centreline, normal),
          .flat_normal = normal,
          .stiffness_ratio = ratio * ratio};
}

}  // namespace

ChosenMaterials choose_materials(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                 const std::vector<DomainModes>& modes, const LeftOut& left_out) {
  ChosenMaterials chosen;
  for (const DomainSolid& domain : solids) chosen.materials.push_back(domain.material);
  if (job.species.model.model == MaterialModel::PowerLaw) return chosen;
  const std::vector<DomainId> domains = left_out.remaining();
  std::vector<ModelledDomain> modelled;
  for (const DomainId id : domains) {
    const Domain& domain = job.plant.domains[id.index()];
    modelled.push_back({job.groups[id.index()], domain.kind, domain.level, solids[id.index()].solid.length,
                        modes[id.index()].frequencies.front()});
  }
  ModelFrequencies found = model_frequencies(job.species, modelled);
  chosen.notes = std::move(found.notes);
  for (size_t i = 0; i < domains.size(); ++i)
    chosen.materials[domains[i].index()] =
        evaluate_at(job.species.group(modelled[i].group), modelled[i].length, found.frequencies[i]);
  return chosen;
}

std::vector<DomainId> ids_in_bake(size_t domains, const LeftOut& left_out) {
  std::vector<DomainId> ids(domains);
  size_t next = 0;
  for (const DomainId id : left_out.remaining()) ids[id.index()] = DomainId(next++);
  return ids;
}

Bake apply_laws(const BakeJob& job, const std::vector<DomainSolid>& solids,
                const std::vector<DomainModes>& modes, const std::vector<DomainMaterial>& materials,
                const LeftOut& left_out) {
  job.progress.begin("laws", solids.size());
  const std::vector<DomainId> new_id = ids_in_bake(solids.size(), left_out);
  Bake bake;
  bake.plant = job.plant.name, bake.plant_hash = job.plant.source_hash, bake.law = job.species;
  for (size_t i = 0; i < solids.size(); ++i) {
    const DomainId id(i);
    job.progress.advance();
    if (left_out.has(id)) {
      bake.failed.push_back(left_out.describe(job.plant, id));
      continue;
    }
    BakedDomain domain = baked(job, i, solids[i], modes[i], materials[i]);
    if (const DomainId parent = left_out.parent_of(job.plant, id); parent.valid())
      domain.parent = new_id[parent.index()];
    domain.solved_as = new_id[modes[i].solved_as];
    bake.domains.push_back(std::move(domain));
  }
  return bake;
}

}  // namespace liana
