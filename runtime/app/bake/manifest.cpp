#include "runtime/app/bake/manifest.h"

#include <fmt/core.h>

#include <charconv>
#include <map>

#include "materials/law/toml_table.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

/// Options that the run of a manifest gives itself.
constexpr std::string_view kReserved[] = {"-o",        "--output",  "-s",      "--species",
                                          "--report",  "--threads", "--shard", "--manifest",
                                          "--summary", "--merge",   "--jobs"};

fs::path absolute_from(const fs::path& folder, const fs::path& path) {
  return (path.is_absolute() ? path : folder / path).lexically_normal();
}

std::vector<std::string> read_options(const TomlTable& table, const std::string& key) {
  std::vector<std::string> options = table.texts(key);
  for (const std::string& option : options)
    for (const std::string_view reserved : kReserved)
      if (option.substr(0, option.find('=')) == reserved)
        table.fail(key, fmt::format("has {}, which the manifest itself decides", reserved),
                   "keys are file, species, output, set and options");
  return options;
}

struct Defaults {
  std::string species;
  fs::path folder;
  std::vector<std::string> options;
};

/// A name, or a path relative to the manifest.
std::string species_from(const fs::path& folder, const std::string& species) {
  const bool is_file = species.find('/') != std::string::npos || species.ends_with(".toml");
  return is_file ? absolute_from(folder, species).string() : species;
}

ManifestItem read_item(const TomlTable& table, const Defaults& defaults, const fs::path& folder) {
  ManifestItem item;
  item.line = table.line();
  item.plant = absolute_from(folder, table.text("file"));
  const std::string species = table.text_or("species", defaults.species);
  if (species.empty()) table.fail("species", "is missing", "give it here or in [defaults]");
  item.species = species_from(folder, species);
  const fs::path output = table.text_or("output", (defaults.folder / item.plant.stem()).string() + ".bake");
  item.output = absolute_from(folder, output);
  item.label = output.string();
  item.options = defaults.options;
  for (const std::string& option : read_options(table, "options")) item.options.push_back(option);
  for (const std::string& assignment : table.texts("set"))
    item.options.insert(item.options.end(), {"--set", assignment});
  table.refuse_unknown_keys();
  return item;
}

}  // namespace

std::vector<ManifestItem> read_manifest(const fs::path& path) {
  const TomlTable table = TomlTable::read(path);
  const fs::path folder = fs::absolute(path).parent_path();
  Defaults defaults;
  if (const auto given = table.table("defaults")) {
    defaults = {given->text_or("species", ""), given->text_or("folder", ""), read_options(*given, "options")};
    given->refuse_unknown_keys();
  }
  std::vector<ManifestItem> items;
  std::map<fs::path, size_t> line_of;
  for (const TomlTable& entry : table.tables("plant")) {
    items.push_back(read_item(entry, defaults, folder));
    const ManifestItem& item = items.back();
    if (const auto [first, is_new] = line_of.emplace(item.output, item.line); !is_new)
      throw Error(Error::Kind::Input,
                  fmt::format("{}: the plants of lines {} and {} have the same output, {}", path.string(),
                              first->second, item.line, item.output.string()),
                  "give one of them an output of its own: output = \"...\"");
  }
  table.refuse_unknown_keys();
  if (items.empty())
    throw Error(Error::Kind::Input, path.string() + ": there is no [[plant]] in it",
                "add for example: [[plant]] file = \"tree.glb\" species = \"apple\"");
  return items;
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char *first = text.data(), *last = first + text.size();
  const auto [slash, code] = std::from_chars(first, last, shard.index);
  if (code == std::errc() && slash != last && *slash == '/') {
    const auto [end, code2] = std::from_chars(slash + 1, last, shard.count);
    if (code2 == std::errc() && end == last && shard.index >= 1 && shard.index <= shard.count) return shard;
  }
  throw Error(Error::Kind::Usage, "--shard " + text + ": is no part of the whole",
              "the second of five parts is --shard 2/5");
}

}  // namespace liana
