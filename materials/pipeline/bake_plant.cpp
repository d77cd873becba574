#include "materials/pipeline/bake_plant.h"

#include "materials/pipeline/apply_laws.h"
#include "materials/pipeline/bake_notes.h"
#include "mesher/base/stopwatch.h"

namespace liana {

BakeResult bake_plant(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
                      Progress& progress) {
  const Stopwatch whole;
  BakeResult result;
  const std::vector<std::string> groups = groups_of(plant, species);
  const BakeJob job{plant, species, groups, options, progress};

  std::vector<DomainSolid> solids;
  result.seconds.surface = timed([&] { solids = make_solids(job); });
  LeftOut left_out = failures_of(solids);
  left_out.refuse(plant, options.strict);

  // A domain without modes is left out, and its ancestors carry less: solve again until all that remain have
  // modes.
  std::vector<DomainModes> modes;
  double tet_seconds = 0, mode_seconds = 0;
  const double solving = timed([&] {
    for (bool again = true; again;) {
      const std::vector<std::vector<CarriedMass>> carried = carried_masses(job, solids, left_out);
      FoundModes found = find_modes(job, solids, carried, left_out);
      tet_seconds += found.tet_seconds, mode_seconds += found.mode_seconds;
      modes = std::move(found.modes);
      again = left_out.add(found.failures);
      left_out.refuse(plant, options.strict);
    }
  });
  const double worked = tet_seconds + mode_seconds;  // none if all was in the cache
  result.seconds.tets = worked > 0 ? tet_seconds / worked * solving : 0;
  result.seconds.modal = solving - result.seconds.tets;

  result.seconds.laws = timed([&] {
    const ChosenMaterials chosen = choose_materials(job, solids, modes, left_out);
    result.bake = apply_laws(job, solids, modes, chosen.materials, left_out);
    result.notes = chosen.notes;
  });
  const std::vector<std::string> notes = bake_notes(job, solids, modes, left_out);
  result.notes.insert(result.notes.end(), notes.begin(), notes.end());
  result.baked_as = ids_in_bake(plant.domains.size(), left_out);
  result.seconds.total = whole.seconds();
  return result;
}

}  // namespace liana
