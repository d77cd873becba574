// The segmented plant as a glTF 2.0 file (.glb, .gltf): one node with one mesh per domain, parenting is
// attachment.
#pragma once

#include <filesystem>

#include "mesher/plant/segmented_plant.h"

namespace liana {

/// Reads, validates, applies node transforms, and welds positions per domain. Domains come parents first; a
/// node without mesh only carries its transform. Throws Error{Input} naming file, node and what to do.
SegmentedPlant read_plant(const std::filesystem::path& path);

/// Writes the same form (names, parents, extras.liana), so that read_plant gives the plant back.
void write_plant(const SegmentedPlant& plant, const std::filesystem::path& path);

}  // namespace liana
