#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "materials/bake/bake_file.h"
#include "materials/law/law_override.h"
#include "materials/law/material_model.h"
#include "materials/law/species_file.h"
#include "materials/pipeline/bake_plant.h"
#include "materials/pipeline/bake_report.h"
#include "materials/pipeline/baked_solids.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/io/plant_file.h"
#include "runtime/app/bake_table.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct BakeArguments {
  fs::path plant, output, report, vtu;
  std::string species, model;
  std::vector<std::string> overrides;
  BakeOptions options;
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

void print_seconds(const StageSeconds& s) {
  fmt::print("seconds: read {:.2f}, surface {:.2f}, tets {:.2f}, modal {:.2f}, laws {:.2f}, total {:.2f}\n",
             s.read, s.surface, s.tets, s.modal, s.laws, s.total);
}

int bake(BakeArguments arguments) {
  if (arguments.output.empty()) arguments.output = arguments.plant.filename().replace_extension(".bake");
  require_writable_folder(arguments.output);
  if (!arguments.report.empty()) require_writable_folder(arguments.report);
  if (!arguments.vtu.empty()) require_writable_folder(arguments.vtu);

  const Stopwatch watch;
  const SpeciesFile species = read_law(arguments);
  BakeResult result;
  VtuMesh tets;
  double read_seconds = 0;
  {
    TerminalProgress progress;  // from here on Ctrl-C is ours
    SegmentedPlant plant;
    read_seconds = timed([&] { plant = read_plant(arguments.plant); });
    progress.throw_if_cancelled();
    result = bake_plant(plant, species.law, arguments.options, progress);
    progress.throw_if_cancelled();
    if (!arguments.vtu.empty()) tets = domains_vtu(result.bake, baked_solids(plant, result.bake));
  }
  if (!arguments.vtu.empty()) write_vtu(tets, arguments.vtu);
  result.bake.species_hash = species.hash;
  result.seconds.read = read_seconds;
  result.seconds.total = watch.seconds();
  write_bake(result.bake, arguments.output);
  if (!arguments.report.empty()) write_file(arguments.report, bake_report(result));

  fmt::print("{} as {}: {} domains -> {}\n\n{}\n", arguments.plant.string(), species.law.species,
             result.bake.domains.size(), arguments.output.string(), bake_table(result.bake));
  print_seconds(result.seconds);
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
  return result.bake.failed.empty() ? kSuccess : kPartial;
}

}  // namespace

void add_bake_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* verb =
      app.add_subcommand("bake", "Turn a segmented plant (.glb, .gltf) and a species into a bake");
  verb->add_option("plant", arguments->plant,
                   "The plant: one node with a mesh per branch or leaf, metres, +Y up")
      ->required();
  verb->add_option("-s,--species", arguments->species,
                   "A preset's name (see liana inspect --species) or a .toml file")
      ->required()
      ->option_text("NAME");
  verb->add_option("-o,--output", arguments->output, "The bake to write [the plant's name with .bake, here]");
  verb->add_option("--report", arguments->report, "Also write what was found as JSON");
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
  verb->add_option("--element", arguments->options.element,
                   "T10 (accurate) or T4 (far too stiff: for comparison)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Element>{{"T10", Element::T10}, {"T4", Element::T4}}, CLI::ignore_case))
      ->option_text("T10|T4");
  verb->add_option("--threads", arguments->options.threads, "Threads to use [all cores]")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  verb->add_flag("--strict", arguments->options.strict, "Stop at the first domain that cannot be made solid");
  verb->footer(
      "Example:\n"
      "  liana bake data/plants/apple_small.glb --species apple -o apple.bake --report report.json\n\n"
      "Exit code: 0 baked, 1 bad input, 2 bad command line, 3 baked but for some domains, 130 stopped by "
      "Ctrl-C");
  verb->callback([arguments, &exit_code] { exit_code = bake(*arguments); });
}

}  // namespace liana
