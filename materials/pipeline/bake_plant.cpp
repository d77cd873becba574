#include "materials/pipeline/bake_plant.h"

#include "materials/pipeline/stages.h"
#include "mesher/base/stopwatch.h"

namespace liana {

BakeResult bake_plant(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
                      Progress& progress) {
  BakeResult result;
  const Stopwatch whole;
  Stages stages(plant, species, options, progress);

  result.seconds.surface = timed([&] { stages.make_surfaces(); });
  // A domain without modes is left out, and its ancestors carry less: solve again until all that remain have
  // modes.
  const double solving = timed([&] {
    do stages.carry_descendants();
    while (!stages.find_modes());
  });
  const double worked = stages.tet_seconds() + stages.mode_seconds();  // none if all was in the cache
  const double tets_share = worked > 0 ? stages.tet_seconds() / worked : 0;
  result.seconds.tets = tets_share * solving;
  result.seconds.modal = (1 - tets_share) * solving;
  result.seconds.laws = timed([&] { result.bake = stages.apply_laws(); });

  result.baked_as = stages.baked_as();
  result.notes = stages.notes();
  result.seconds.total = whole.seconds();
  return result;
}

}  // namespace liana
