// A library of plants to bake: plants.toml.
//
//   [defaults]                 # for the plants that say nothing else; all optional
//   species = "apple"
//   folder = "bakes"           # of the outputs
//   options = ["--strict"]     # more options of liana bake
//
//   [[plant]]
//   file = "plants/a.glb"      # paths are relative to the manifest
//   species = "birch"
//   output = "bakes/a.bake"    # default: folder / name of the plant + .bake
//   set = ["level0.reference_frequency=1.2"]
//   options = []
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace liana {

struct ManifestItem {
  std::filesystem::path plant, output;  ///< absolute
  std::string species;                  ///< a preset's name, or the absolute path of a file
  std::vector<std::string> options;     ///< of liana bake, --set included
  size_t line = 0;                      ///< of the manifest
  std::string label;                    ///< the output as the manifest's reader sees it
};

/// Throws Error{Input} with file and line; for two plants with one output both lines are named. Whether
/// plants and species exist is not looked at: that is the matter of one item, not of all.
std::vector<ManifestItem> read_manifest(const std::filesystem::path& path);

/// The i-th of n parts, i from 1: "2/5". Items are dealt like cards, so that parts take about as long.
struct Shard {
  size_t index = 1, count = 1;
  bool has(size_t item) const { return item % count == index - 1; }
};
Shard parse_shard(const std::string& text);  ///< throws Error{Usage}

}  // namespace liana
