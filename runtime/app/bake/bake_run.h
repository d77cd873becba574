// One bake: a plant and a species in, a bake and what is to be written beside it out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "materials/cache/bake_cache.h"
#include "materials/pipeline/bake_plant.h"
#include "mesher/shells/load_plant.h"

namespace liana {

struct BakeRun {
  std::filesystem::path plant;
  LoadOptions load;
  std::string species;                 ///< a preset's name, or a file
  std::string model;                   ///< empty: the species' own
  std::vector<std::string> overrides;  ///< of the species' numbers, KEY=VALUE
  int merge_below = -1;                ///< level; -1: keep all domains
  BakeOptions options;
  bool no_cache = false;
  std::filesystem::path cache_folder = default_cache_folder();
  std::filesystem::path output;                     ///< empty: the plant's name with .bake, here
  std::filesystem::path report, html, models, vtu;  ///< written only where given
};

/// Prints what was baked. Returns kSuccess, or kPartial where a domain was left out.
int bake(BakeRun run);

}  // namespace liana
