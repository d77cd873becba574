#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "materials/bake/bake_file.h"
#include "materials/law/material_model.h"
#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "runtime/app/bake/bake_table.h"
#include "runtime/app/inspect/inspect.h"
#include "runtime/world/scene/scene_file.h"

namespace liana {
namespace {

using Json = nlohmann::json;

std::string point(const Vec3& p) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", p.x(), p.y(), p.z());
}

/// What a group claims of the plant: `name "frond*", branches, level 1`.
std::string match_text(const GroupMatch& match) {
  std::vector<std::string> parts;
  if (!match.name.empty()) parts.push_back(fmt::format("name \"{}\"", match.name));
  if (match.kind) parts.push_back(*match.kind == DomainKind::Leaf ? "leaves" : "branches");
  if (match.level >= 0) parts.push_back(fmt::format("level {}", match.level));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// "key value" for every plain value, one level of nesting in one line, and the length of every list.
std::string json_outline(const Json& json) {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (value.is_array())
      text += fmt::format("{:<22} {} entries\n", key, value.size());
    else
      text += fmt::format("{:<22} {}\n", key, value.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  return text;
}

}  // namespace

std::string inspect_bake(const std::filesystem::path& path, const InspectOptions& options) {
  const Bake bake = read_bake(path);
  std::string text = fmt::format(
      "{}: a bake (version {}) of {} as {}\nplant hash {}, species hash {}; SI units, plant frame, +Y "
      "up\n\n{}",
      path.string(), kBakeVersion, bake.plant, bake.law.species, hash_text(bake.plant_hash),
      hash_text(bake.species_hash), bake_table(bake));
  if (options.all_domains) return text + "\n" + domain_table(bake);
  return text + "(every domain: --domains)\n";
}

std::string inspect_species(const std::filesystem::path& path) {
  const SpeciesFile species = read_species_file(path);
  std::string text = fmt::format("{}: species '{}': {}\nhash    {}\n", path.string(), species.law.species,
                                 species.description, hash_text(species.hash));
  text += fmt::format("model   {}\n", model_name(species.law.model.model));
  for (const auto& [name, group] : species.law.groups)
    if (!group.match.empty()) text += fmt::format("group   {} claims {}\n", name, match_text(group.match));
  text += fmt::format("\n{:<40} {:>10}  {:<12} {:<8} {}\n", "number", "value", "unit", "sure?", "source");
  for (const SourcedNumber& number : species.numbers)
    text += fmt::format("{:<40} {:>10.6g}  {:<12} {:<8} {}\n", number.where, number.value, number.unit,
                        number.confidence, number.source);
  return text;
}

std::string inspect_scene(const std::filesystem::path& path) {
  const Scene scene = read_scene(path);
  std::string text =
      fmt::format("{}: scene '{}'\nstep {} s, {} s long, seed {}, gravity {} m/s², wind {} m/s\n",
                  path.string(), scene.title, scene.time_step, scene.seconds, scene.seed,
                  point(scene.gravity), point(scene.wind.velocity));
  for (const SceneObstacle& obstacle : scene.obstacles)
    text += fmt::format("obstacle {}: {} triangles\n", obstacle.name, obstacle.mesh.triangles.size());
  for (const ScenePlant& plant : scene.plants)
    text += fmt::format("plant    {} at {} m\n", plant.bake.string(), point(plant.position));
  for (const SceneClimber& climber : scene.climbers)
    text +=
        fmt::format("climber  {} at {} m\n", climber.bake.empty() ? climber.species : climber.bake.string(),
                    point(climber.position));
  return text;
}

std::string inspect_report(const std::filesystem::path& path) {
  const Json json = Json::parse(read_file(path), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object())
    throw Error(Error::Kind::Input, path.string() + ": is damaged JSON", "write the report again");
  const char* kind = json.contains("max_frequency_error") ? "a report of liana verify"
                     : json.contains("state_hash")        ? "a report of liana simulate"
                     : json.contains("domains")           ? "a report of liana bake"
                                                          : nullptr;
  if (!kind)
    throw Error(Error::Kind::Input, path.string() + ": is JSON, but no report of ours",
                "reports come from liana bake --report, verify --json and simulate --report");
  return fmt::format("{}: {}\n{}", path.string(), kind, json_outline(json));
}

std::string list_species() {
  std::string text;
  for (const std::string& name : species_names())
    text += fmt::format("{:<12} {}\n", name, read_species_file(find_species(name)).description);
  return text;
}

}  // namespace liana
