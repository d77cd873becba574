#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "materials/bake/bake_file.h"
#include "materials/law/law_override.h"
#include "materials/law/material_model.h"
#include "materials/law/species_file.h"
#include "materials/pipeline/bake_cache.h"
#include "materials/pipeline/bake_plant.h"
#include "materials/pipeline/bake_report.h"
#include "materials/pipeline/baked_solids.h"
#include "materials/pipeline/html_report.h"
#include "materials/pipeline/model_comparison.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/surface/merge_domains.h"
#include "runtime/app/bake_table.h"
#include "runtime/app/manifest_run.h"
#include "runtime/app/plant_options.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct BakeArguments {
  fs::path plant, output, report, html, models, vtu;
  std::string species, model;
  std::vector<std::string> overrides;
  BakeOptions options;
  int merge_below = -1;  ///< level; -1: keep all domains
  fs::path cache_folder = default_cache_folder();
  bool no_cache = false;
  ManifestRun manifest;
  std::string shard;
  LoadOptions load;
};

SpeciesFile read_law(const BakeArguments& arguments) {
  SpeciesFile species = read_species_file(find_species(arguments.species));
  for (const std::string& assignment : arguments.overrides) {
    set_number(species.law, assignment);
    species.hash = hash_bytes(assignment.data(), assignment.size(), species.hash);
  }
  if (!arguments.model.empty()) {
    species.law.model.model = model_named(arguments.model);
    species.hash = hash_bytes(arguments.model.data(), arguments.model.size(), species.hash);
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

int bake(BakeArguments arguments) {
  if (arguments.output.empty()) arguments.output = arguments.plant.filename().replace_extension(".bake");
  require_writable_folder(arguments.output);
  for (const fs::path& extra : {arguments.report, arguments.html, arguments.models, arguments.vtu})
    if (!extra.empty()) require_writable_folder(extra);

  const Stopwatch watch;
  const SpeciesFile species = read_law(arguments);
  SegmentedPlant plant;
  BakeResult result;
  std::optional<BakeCache> cache;
  VtuMesh tets;
  double read_seconds = 0, cache_seconds = 0;
  {
    TerminalProgress progress;  // from here on Ctrl-C is ours
    read_seconds = timed([&] { plant = load_plant(arguments.plant, arguments.load); });
    progress.throw_if_cancelled();
    if (arguments.merge_below >= 0)
      plant = merge_below(plant, arguments.merge_below, arguments.options.threads, progress).plant;
    if (!arguments.no_cache && !arguments.cache_folder.empty()) {
      cache_seconds += timed([&] { cache.emplace(cache_file(arguments.cache_folder, arguments.plant)); });
      arguments.options.cache = &*cache;
    }
    result = bake_plant(plant, species.law, arguments.options, progress);
    result.notes.insert(result.notes.begin(), plant.notes.begin(), plant.notes.end());
    progress.throw_if_cancelled();
    if (!arguments.vtu.empty()) tets = domains_vtu(result.bake, baked_solids(plant, result.bake));
  }
  if (!arguments.vtu.empty()) write_vtu(tets, arguments.vtu);
  result.bake.species_hash = species.hash;
  result.seconds.read = read_seconds;
  result.seconds.write = timed([&] { write_bake(result.bake, arguments.output); });
  if (cache) cache_seconds += timed([&] { save_cache(*cache, result.notes); });
  result.seconds.cache = cache_seconds;
  result.seconds.total = watch.seconds();
  if (!arguments.report.empty()) write_file(arguments.report, bake_report(result));
  if (!arguments.html.empty()) write_file(arguments.html, html_report(plant, result));
  if (!arguments.models.empty())
    write_file(arguments.models, comparison_csv(result.bake, compare_models(result.bake)));

  fmt::print("{} as {}: {} domains -> {}\n\n{}\n", arguments.plant.string(), species.law.species,
             result.bake.domains.size(), arguments.output.string(), bake_table(result.bake));
  print_seconds(result.seconds);
  if (cache)
    fmt::print("cache: {} found, {} new ({})\n", cache->hits(), cache->misses(), cache->file().string());
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
  return result.bake.failed.empty() ? kSuccess : kPartial;
}

/// --manifest and the options that go with it; the others belong into the manifest.
void add_manifest_options(CLI::App& verb, BakeArguments& arguments) {
  CLI::Option* manifest =
      verb.add_option("--manifest", arguments.manifest.manifest,
                      "Bake all plants of a list (.toml); what is baked already and unchanged is kept")
          ->option_text("FILE");
  verb.add_option("--jobs", arguments.manifest.jobs, "Plants of the manifest at a time [one a core]")
      ->check(CLI::Range(1, 1024))
      ->option_text("N")
      ->needs(manifest);
  verb.add_option("--shard", arguments.shard, "Only the i-th of n parts of the manifest, as 2/5")
      ->option_text("I/N")
      ->needs(manifest);
  verb.add_flag("--merge", arguments.manifest.merge, "Bake nothing: sum up what the shards have baked")
      ->needs(manifest);
}

int bake_manifest(const CLI::App& verb, BakeArguments& arguments) {
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    const bool known = name == "--manifest" || name == "--jobs" || name == "--shard" || name == "--merge" ||
                       name == "--threads";
    if (option->count() > 0 && !known)
      throw Error(Error::Kind::Usage, name + " does not go with --manifest",
                  "write it into the manifest: options = [\"" + name + "\"]");
  }
  if (!arguments.shard.empty()) arguments.manifest.shard = parse_shard(arguments.shard);
  arguments.manifest.threads = arguments.options.threads;
  return run_manifest(arguments.manifest);
}

}  // namespace

void add_bake_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* verb = app.add_subcommand(
      "bake", "Turn a plant (.glb, .gltf, .obj, .ply, .mtg, .json) and a species into a bake");
  verb->add_option("plant", arguments->plant,
                   "The plant: a mesh, merged or with a node per branch and leaf, or a skeleton");
  add_plant_options(*verb, arguments->load);
  verb->add_option("-s,--species", arguments->species,
                   "A preset's name (see liana inspect --species) or a .toml file")
      ->option_text("NAME");
  verb->add_option("-o,--output", arguments->output, "The bake to write [the plant's name with .bake, here]");
  verb->add_option("--report", arguments->report, "Also write what was found as JSON");
  verb->add_option("--html", arguments->html,
                   "Also write it as a page for a browser: 3-D view, curves, table")
      ->option_text("FILE");
  verb->add_option("--compare-models", arguments->models,
                   "Also write what each material model would give, as CSV")
      ->option_text("FILE");
  verb->add_option("--vtu", arguments->vtu,
                   "Also write the tets with frequency, material and lowest mode for ParaView");
  verb->add_option("--set", arguments->overrides,
                   "Change a number of the species, as level0.reference_frequency=1.2; repeatable")
      ->allow_extra_args(false)
      ->option_text("KEY=VALUE");
  verb->add_option("--model", arguments->model,
                   "What gives frequencies: power (law), constant, depth or median [the species', power]")
      ->check([](const std::string& name) {
        const std::string problem = model_name_problem(name);
        return problem.empty() ? problem : "--model " + problem;
      })
      ->option_text("NAME");
  verb->add_option("--merge-below", arguments->merge_below,
                   "Make a branch of this level and all branches on it one domain (0: the trunk)")
      ->check(CLI::Range(0, 1000))
      ->option_text("LEVEL");
  verb->add_option("--element", arguments->options.element,
                   "T10 (accurate) or T4 (far too stiff: for comparison)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Element>{{"T10", Element::T10}, {"T4", Element::T4}}, CLI::ignore_case))
      ->option_text("T10|T4");
  verb->add_option("--threads", arguments->options.threads, "Threads to use [all cores]")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  verb->add_option("--cache-dir", arguments->cache_folder,
                   "Where solids and modes are kept for the next bake of the plant")
      ->option_text("FOLDER")
      ->default_str("$XDG_CACHE_HOME/liana");
  verb->add_flag("--no-cache", arguments->no_cache, "Compute everything, keep nothing");
  verb->add_flag("--strict", arguments->options.strict, "Stop at the first domain that cannot be made solid");
  verb->footer(
      "Example:\n"
      "  liana bake data/plants/apple_small.glb --species apple -o apple.bake --report report.json\n"
      "  liana bake --manifest plants.toml\n\n"
      "Exit code: 0 baked, 1 bad input, 2 bad command line, 3 baked but for some domains, 130 stopped by "
      "Ctrl-C");
  add_manifest_options(*verb, *arguments);
  verb->callback([arguments, verb, &exit_code] {
    if (!arguments->manifest.manifest.empty()) {
      exit_code = bake_manifest(*verb, *arguments);
      return;
    }
    if (arguments->plant.empty()) throw CLI::RequiredError("plant");
    if (arguments->species.empty()) throw CLI::RequiredError("--species");
    exit_code = bake(*arguments);
  });
}

}  // namespace liana
