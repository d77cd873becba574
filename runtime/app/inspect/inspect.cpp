#include "runtime/app/inspect/inspect.h"

#include <fmt/core.h>

#include "materials/bake/bake_file.h"
#include "materials/law/toml_table.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"

namespace liana {
namespace {

constexpr const char* kUnderstood =
    "liana inspect reads plants (.glb, .gltf, .obj, .ply, .mtg, .json), bakes (.bake), species and scenes "
    "(.toml) and reports (.json)";

bool is_json(std::string_view bytes) {
  const size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && bytes[first] == '{';
}

std::string inspect_toml(const std::filesystem::path& path) {
  const TomlTable table = TomlTable::read(path);
  if (table.has("default_material") || table.has("groups")) return inspect_species(path);
  for (const char* key : {"climber", "plant", "obstacle", "camera", "wind", "title", "seconds"})
    if (table.has(key)) return inspect_scene(path);
  throw Error(Error::Kind::Input, path.string() + ": is a TOML file, but neither a species nor a scene",
              kUnderstood);
}

}  // namespace

std::string inspect_file(const std::filesystem::path& path, const InspectOptions& options) {
  const std::string bytes = read_file(path);
  const std::string extension = path.extension().string();
  if (is_bake(bytes) || extension == ".bake") return inspect_bake(path, options);
  if (is_plant_file(path, bytes)) return inspect_plant(path, options);
  if (extension == ".toml") return inspect_toml(path);
  if (is_json(bytes)) return inspect_report(path);
  throw Error(Error::Kind::Input, path.string() + ": is of no kind that is known here", kUnderstood);
}

}  // namespace liana
