#include <fmt/core.h>

#include <cstdlib>
#include <set>

#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace fs = std::filesystem;

std::vector<fs::path> species_folders() {
  std::vector<fs::path> candidates;
  if (const char* data = std::getenv("LIANA_DATA")) candidates.push_back(fs::path(data) / "species");
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code) {
    // <prefix>/bin/liana finds <prefix>/share/liana; <tree>/build/release/liana finds <tree>/data.
    candidates.push_back(program.parent_path().parent_path() / "share/liana/species");
    for (fs::path folder = program.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
      candidates.push_back(folder / "data/species");
  }
  candidates.push_back(fs::path(LIANA_SOURCE_DATA) / "species");

  std::vector<fs::path> folders;
  for (const fs::path& folder : candidates) {
    const bool is_new = std::find(folders.begin(), folders.end(), folder) == folders.end();
    if (is_new && fs::is_directory(folder, code)) folders.push_back(folder);
  }
  return folders;
}

std::vector<std::string> species_names() {
  std::set<std::string> names;
  for (const fs::path& folder : species_folders())
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  return {names.begin(), names.end()};
}

fs::path find_species(const std::string& name_or_path) {
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml")) return name_or_path;
  std::error_code ignored;
  for (const fs::path& folder : species_folders())
    if (const fs::path file = folder / (name_or_path + ".toml"); fs::is_regular_file(file, ignored))
      return file;

  const std::vector<std::string> names = species_names();
  if (names.empty())
    throw Error(Error::Kind::Input, fmt::format("species '{}': there is no species folder", name_or_path),
                "set LIANA_DATA to the folder that holds species/, or give the path of a .toml file");
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  throw Error(Error::Kind::Input, fmt::format("there is no species '{}'", name_or_path),
              fmt::format("did you mean '{}'? There are: {}; or give the path of a .toml file",
                          nearest_word(name_or_path, names), all));
}

}  // namespace liana
