#include "runtime/app/bake/bake_run.h"

#include <fmt/core.h>

#include <optional>

#include "materials/bake/bake_file.h"
#include "materials/law/law_override.h"
#include "materials/law/material_model.h"
#include "materials/law/species_file.h"
#include "materials/pipeline/baked_solids.h"
#include "materials/report/bake_report.h"
#include "materials/report/html_report.h"
#include "materials/report/model_comparison.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/base/stopwatch.h"
#include "mesher/solids/unions/merge_domains.h"
#include "runtime/app/bake/bake_table.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

SpeciesFile read_law(const BakeRun& run) {
  SpeciesFile species = read_species_file(find_species(run.species));
  for (const std::string& assignment : run.overrides) {
    set_number(species.law, assignment);
    species.hash = hash_bytes(assignment.data(), assignment.size(), species.hash);
  }
  if (!run.model.empty()) {
    species.law.model.model = model_named(run.model);
    species.hash = hash_bytes(run.model.data(), run.model.size(), species.hash);
  }
  return species;
}

/// Each stage's seconds and share of the total.
void print_seconds(const StageSeconds& s) {
  const std::pair<const char*, double> stages[] = {
      {"read", s.read},   {"cache", s.cache}, {"surface", s.surface}, {"tets", s.tets},
      {"modal", s.modal}, {"laws", s.laws},   {"write", s.write}};
  std::string text;
  for (const auto& [name, seconds] : stages)
    text += fmt::format("{} {:.2f} ({:.0f} %), ", name, seconds, 100 * seconds / s.total);
  fmt::print("seconds: {}total {:.2f}\n", text, s.total);
}

/// A cache that cannot be kept costs time at the next bake and nothing now.
void save_cache(BakeCache& cache, std::vector<std::string>& notes) {
  if (cache.was_damaged())
    notes.push_back(cache.file().string() + ": was damaged, nothing of it was used, and it was made anew");
  try {
    cache.save();
  } catch (const Error& error) {
    notes.push_back(std::string("the cache was not kept: ") + error.what());
  }
}

void write_beside(const BakeRun& run, const SegmentedPlant& plant, const BakeResult& result) {
  if (!run.report.empty()) write_file(run.report, bake_report(result));
  if (!run.html.empty()) write_file(run.html, html_report(plant, result));
  if (!run.models.empty()) write_file(run.models, comparison_csv(result.bake, compare_models(result.bake)));
}

void print_result(const BakeRun& run, const std::string& species, const BakeResult& result) {
  fmt::print("{} as {}: {} domains -> {}\n\n{}\n", run.plant.string(), species, result.bake.domains.size(),
             run.output.string(), bake_table(result.bake));
  print_seconds(result.seconds);
}

}  // namespace

int bake(BakeRun run) {
  if (run.output.empty()) run.output = run.plant.filename().replace_extension(".bake");
  require_writable_folder(run.output);
  for (const fs::path& extra : {run.report, run.html, run.models, run.vtu})
    if (!extra.empty()) require_writable_folder(extra);

  const Stopwatch watch;
  const SpeciesFile species = read_law(run);
  SegmentedPlant plant;
  BakeResult result;
  std::optional<BakeCache> cache;
  double read_seconds = 0, cache_seconds = 0;
  {
    TerminalProgress progress;  // from here on Ctrl-C is ours
    read_seconds = timed([&] { plant = load_plant(run.plant, run.load); });
    progress.throw_if_cancelled();
    if (run.merge_below >= 0)
      plant = merge_below(plant, run.merge_below, run.options.threads, progress).plant;
    if (!run.no_cache && !run.cache_folder.empty()) {
      cache_seconds += timed([&] { cache.emplace(cache_file(run.cache_folder, run.plant)); });
      run.options.cache = &*cache;
    }
    result = bake_plant(plant, species.law, run.options, progress);
    result.notes.insert(result.notes.begin(), plant.notes.begin(), plant.notes.end());
    progress.throw_if_cancelled();
  }
  result.bake.species_hash = species.hash;
  result.seconds.read = read_seconds;
  result.seconds.write = timed([&] { write_bake(result.bake, run.output); });
  if (cache) cache_seconds += timed([&] { save_cache(*cache, result.notes); });
  result.seconds.cache = cache_seconds;
  result.seconds.total = watch.seconds();
  write_beside(run, plant, result);
  print_result(run, species.law.species, result);
  if (cache)
    fmt::print("cache: {} found, {} new ({})\n", cache->hits(), cache->misses(), cache->file().string());
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
  if (!run.vtu.empty()) {  // last: it takes as long again, and whatever becomes of it, the bake is there
    TerminalProgress progress;
    const VtuMesh tets = domains_vtu(result.bake, baked_solids(plant, result.bake));
    progress.throw_if_cancelled();
    write_vtu(tets, run.vtu);
  }
  return result.bake.failed.empty() ? kSuccess : kPartial;
}

}  // namespace liana
