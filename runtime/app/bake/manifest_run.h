// Bakes a library of plants.
#pragma once

#include <filesystem>

#include "runtime/app/bake/manifest.h"

namespace liana {

struct ManifestRun {
  std::filesystem::path manifest;
  Shard shard;           ///< of the manifest's plants
  bool merge = false;    ///< bake nothing: say what became of all plants
  unsigned jobs = 0;     ///< plants at a time; 0: one a core
  unsigned threads = 0;  ///< for each; 0: the cores shared among the jobs
};

/// Bakes what is not yet baked, each plant in a process of its own: one that fails, for whatever reason, does
/// not stop the others. Prints the table of results and, but for a shard, writes summary.json. Returns
/// kSuccess or, when a plant failed or was baked in part, kPartial. Throws Error{Input} for the manifest
/// itself, Error{Cancelled}: what is baked stays, and the next run goes on from there.
int run_manifest(const ManifestRun& run);

}  // namespace liana
