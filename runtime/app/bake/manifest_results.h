// What became of each plant of a manifest: one small JSON file a plant, so that runs can be resumed and
// shards merged.
#pragma once

#include <optional>
#include <vector>

#include "runtime/app/bake/manifest.h"

namespace liana {

struct ItemResult {
  enum class State {
    Baked,    ///< in this run
    Kept,     ///< baked before, and nothing it depends on has changed since
    Failed,   ///< no bake
    Waiting,  ///< nothing is known of it yet
  };
  State state = State::Waiting;
  uint64_t key = 0;          ///< hash of everything the bake depends on
  uint64_t output_hash = 0;  ///< of the bake
  size_t domains = 0, left_out = 0;
  double seconds = 0;
  std::string message;  ///< why it failed

  bool complete() const { return (state == State::Baked || state == State::Kept) && left_out == 0; }
};

/// "plants.toml.results" beside the manifest: results, logs and reports.
std::filesystem::path results_folder(const std::filesystem::path& manifest);
/// Where an item's result lies; its log and report lie beside it.
std::filesystem::path result_file(const std::filesystem::path& manifest, const ManifestItem& item);

/// Hash of the plant's file (and the buffers a .gltf names), the species' file, the options and this program.
/// Throws Error{Input} when one cannot be read.
uint64_t key_of(const ManifestItem& item);

void write_result(const std::filesystem::path& manifest, const ManifestItem& item, const ItemResult& result);

/// Kept if a bake of this key lies at the output as it was written; Failed if that is what became of this
/// key; else Waiting.
ItemResult read_result(const std::filesystem::path& manifest, const ManifestItem& item, uint64_t key);

std::string results_table(const std::vector<ManifestItem>& items, const std::vector<ItemResult>& results);
std::string results_json(const std::vector<ManifestItem>& items, const std::vector<ItemResult>& results);

}  // namespace liana
