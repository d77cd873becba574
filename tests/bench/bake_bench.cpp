// Whole bakes in memory, from segmented plants to the bake. domains/s counts wall time on the threads given.
#include <benchmark/benchmark.h>

#include "materials/cache/bake_cache.h"
#include "materials/law/species_file.h"
#include "materials/pipeline/bake_plant.h"
#include "tests/support/plants/large_plants.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

void report(benchmark::State& state, const BakeResult& result) {
  state.counters["domains/s"] =
      benchmark::Counter(double(result.bake.domains.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["failed"] = double(result.bake.failed.size());
  const double tasks = result.seconds.surface + result.seconds.tets + result.seconds.modal;
  state.counters["surface"] = result.seconds.surface / tasks;
  state.counters["tets"] = result.seconds.tets / tasks;
  state.counters["modal"] = result.seconds.modal / tasks;
}

void bake_again(benchmark::State& state, const SegmentedPlant& plant, const BakeOptions& options) {
  const SpeciesLaw law = read_species("apple");
  Progress silent;
  BakeResult result;
  for (auto _ : state) result = bake_plant(plant, law, options, silent);
  report(state, result);
}

/// range(0) branches, no two alike, on range(1) threads.
void bake_unique_branches(benchmark::State& state) {
  BakeOptions options;
  options.threads = static_cast<unsigned>(state.range(1));
  bake_again(state, flatten(make_branch_hierarchy(static_cast<int>(state.range(0)))), options);
}
BENCHMARK(bake_unique_branches)
    ->Args({300, 1})
    ->Args({300, 2})
    ->Args({3000, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// 6,085 domains, 328,000 triangles.
void bake_palm(benchmark::State& state) {
  BakeOptions options;
  options.threads = static_cast<unsigned>(state.range(0));
  bake_again(state, flatten(make_palm()), options);
}
BENCHMARK(bake_palm)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();

/// The palm again after a change of the species: frequencies and damping (0), masses (1).
void bake_palm_again(benchmark::State& state) {
  const SegmentedPlant palm = flatten(make_palm());
  const ScratchFolder folder;
  SpeciesLaw law = read_species("apple");
  Progress silent;
  BakeOptions options;
  {
    BakeCache first(folder / "palm.cache");
    options.cache = &first;
    bake_plant(palm, law, options, silent);
    first.save();
  }
  (state.range(0) ? law.groups["leaf"].c2 : law.groups["level0"].reference_frequency) *= 1.1;
  BakeResult result;
  for (auto _ : state) {
    BakeCache cache(folder / "palm.cache");
    options.cache = &cache;
    result = bake_plant(palm, law, options, silent);
  }
  state.counters["failed"] = double(result.bake.failed.size());
}
BENCHMARK(bake_palm_again)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace liana
