#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "materials/law/material_model.h"
#include "runtime/app/bake/bake_run.h"
#include "runtime/app/bake/manifest_run.h"
#include "runtime/app/plant_options.h"
#include "runtime/app/verbs.h"

namespace liana {
namespace {

struct BakeArguments {
  BakeRun one;
  ManifestRun manifest;
  std::string shard;
};

/// The bake, and what is to be written beside it.
void add_output_options(CLI::App& verb, BakeRun& run) {
  verb.add_option("-o,--output", run.output, "The bake to write [the plant's name with .bake, here]");
  verb.add_option("--report", run.report, "Also write what was found as JSON");
  verb.add_option("--html", run.html, "Also write it as a page for a browser: 3-D view, curves, table")
      ->option_text("FILE");
  verb.add_option("--compare-models", run.models, "Also write what each material model would give, as CSV")
      ->option_text("FILE");
  verb.add_option("--vtu", run.vtu,
                  "Also write the tets with frequency, material and lowest mode for ParaView");
}

/// What is baked: the law, its model and the domains.
void add_law_options(CLI::App& verb, BakeRun& run) {
  verb.add_option("--set", run.overrides,
                  "Change a number of the species, as level0.reference_frequency=1.2; repeatable")
      ->allow_extra_args(false)
      ->option_text("KEY=VALUE");
  verb.add_option("--model", run.model,
                  "What gives frequencies: power (law), constant, depth or median [the species', power]")
      ->check([](const std::string& name) {
        const std::string problem = model_name_problem(name);
        return problem.empty() ? problem : "--model " + problem;
      })
      ->option_text("NAME");
  verb.add_option("--merge-below", run.merge_below,
                  "Make a branch of this level and all branches on it one domain (0: the trunk)")
      ->check(CLI::Range(0, 1000))
      ->option_text("LEVEL");
}

/// How it is computed.
void add_work_options(CLI::App& verb, BakeRun& run) {
  verb.add_option("--element", run.options.element, "T10 (accurate) or T4 (far too stiff: for comparison)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Element>{{"T10", Element::T10}, {"T4", Element::T4}}, CLI::ignore_case))
      ->option_text("T10|T4");
  verb.add_option("--threads", run.options.threads, "Threads to use [all cores]")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  verb.add_option("--cache-dir", run.cache_folder,
                  "Where solids and modes are kept for the next bake of the plant")
      ->option_text("FOLDER")
      ->default_str("$XDG_CACHE_HOME/liana");
  verb.add_flag("--no-cache", run.no_cache, "Compute everything, keep nothing");
  verb.add_flag("--strict", run.options.strict, "Stop at the first domain that cannot be made solid");
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
  arguments.manifest.threads = arguments.one.options.threads;
  return run_manifest(arguments.manifest);
}

}  // namespace

void add_bake_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* verb = app.add_subcommand(
      "bake", "Turn a plant (.glb, .gltf, .obj, .ply, .mtg, .json) and a species into a bake");
  verb->add_option("plant", arguments->one.plant,
                   "The plant: a mesh, merged or with a node per branch and leaf, or a skeleton");
  add_plant_options(*verb, arguments->one.load);
  verb->add_option("-s,--species", arguments->one.species,
                   "A preset's name (see liana inspect --species) or a .toml file")
      ->option_text("NAME");
  add_output_options(*verb, arguments->one);
  add_law_options(*verb, arguments->one);
  add_work_options(*verb, arguments->one);
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
    if (arguments->one.plant.empty()) throw CLI::RequiredError("plant");
    if (arguments->one.species.empty()) throw CLI::RequiredError("--species");
    exit_code = bake(arguments->one);
  });
}

}  // namespace liana
