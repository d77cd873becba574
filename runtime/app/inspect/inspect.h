// What is in a file, as text for people.
#pragma once

#include <filesystem>
#include <string>

#include "mesher/shells/load_plant.h"

namespace liana {

struct InspectOptions {
  bool all_domains = false;  ///< also list every domain
  LoadOptions load;          ///< of a plant
};

/// Any file of ours (bake, species, scene, report) or a plant (mesh or skeleton), told apart by content
/// rather than name. Throws Error{Input} for a file that is none of these, saying which are, or is damaged.
std::string inspect_file(const std::filesystem::path& path, const InspectOptions& options = {});

std::string inspect_plant(const std::filesystem::path& path, const InspectOptions& options);
std::string inspect_bake(const std::filesystem::path& path, const InspectOptions& options);
std::string inspect_species(const std::filesystem::path& path);
std::string inspect_scene(const std::filesystem::path& path);
std::string inspect_report(const std::filesystem::path& path);

/// The names of all species presets and what they are.
std::string list_species();

}  // namespace liana
