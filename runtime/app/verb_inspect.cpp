#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "runtime/app/inspect/inspect.h"
#include "runtime/app/plant_options.h"
#include "runtime/app/verbs.h"

namespace liana {
namespace {

struct InspectArguments {
  std::string file;
  bool species = false;
  InspectOptions options;
};

void inspect(const InspectArguments& arguments) {
  if (arguments.file.empty() && !arguments.species)
    throw Error(Error::Kind::Usage, "inspect what?", "liana inspect FILE, or liana inspect --species");
  if (arguments.species && arguments.file.empty()) return fmt::print("{}", list_species());
  if (arguments.species) return fmt::print("{}", inspect_species(find_species(arguments.file)));
  fmt::print("{}", inspect_file(arguments.file, arguments.options));
}

}  // namespace

void add_inspect_verb(CLI::App& app, int&) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* verb =
      app.add_subcommand("inspect", "Say what is in a file: a plant, bake, species, scene or report");
  verb->add_option("file", arguments->file,
                   "A plant (.glb, .gltf, .obj, .ply, .mtg, .json), .bake, .toml or report");
  add_plant_options(*verb, arguments->options.load);
  verb->add_flag("--domains", arguments->options.all_domains, "List every branch and leaf");
  verb->add_flag("--species", arguments->species, "List the species presets, or show the one named");
  verb->footer(
      "Examples:\n"
      "  liana inspect data/plants/apple_small.glb\n"
      "  liana inspect apple.bake --domains\n"
      "  liana inspect --species apple");
  verb->callback([arguments] { inspect(*arguments); });
}

}  // namespace liana
