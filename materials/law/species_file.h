// A species law as a TOML file in which every number says where it comes from and how sure that is.
//
//   name = "apple"
//   description = "..."
//   [default_material]
//   youngs_modulus = { value = 8.77e9, source = "Niklas 1992", confidence = "high" }
//   [every_group]                # numbers that all groups share; a group's own take precedence
//   epsilon1 = { ... }
//   [groups.level0]              # and level1, ..., leaf, or a name that the plant uses
//   reference_frequency = { ... }
//   [groups.level0.damping]
//   low_factor = { ... }         # or mass_damping and stiffness_damping: the same d_M, d_K for all
//   [groups.frond]
//   match = { name = "frond*", kind = "branch", level = 1 }   # claims these domains; one of the three is
//   enough [model]                      # optional; see material_model.h name = "depth"
//
// A group may give c1 (Hz·m^-epsilon1, [Wang17] Eq. 8) instead of reference_frequency and reference_length.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "materials/law/species_law.h"

namespace liana {

/// One number as the file gives it.
struct SourcedNumber {
  std::string where;  ///< e.g. "groups.level0.damping.low_factor"
  double value;
  std::string unit;
  std::string source;
  std::string confidence;  ///< "high", "medium", "low" or "guess"
};

struct SpeciesFile {
  SpeciesLaw law;
  std::string description;
  std::filesystem::path path;
  uint64_t hash = 0;  ///< of the file
  std::vector<SourcedNumber> numbers;
};

/// Throws Error{Input} "file:line: ..." for anything missing, unknown or absurd.
SpeciesFile read_species_file(const std::filesystem::path& path);

/// find_species, then read_species_file.
SpeciesLaw read_species(const std::string& name_or_path);

/// A path (has a '/' or ends in ".toml") is taken as it is. A name is looked for in species_folders().
/// Throws Error{Input} that suggests the nearest name and lists all.
std::filesystem::path find_species(const std::string& name_or_path);

/// $LIANA_DATA/species, data/species beside or above the program, share/liana/species, the source tree's:
/// those that exist, in this order.
std::vector<std::filesystem::path> species_folders();

/// Names of all presets in species_folders(), sorted.
std::vector<std::string> species_names();

}  // namespace liana
