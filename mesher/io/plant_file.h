// The segmented plant as a glTF 2.0 file (.glb, .gltf): one node with one mesh per domain, parenting is
// attachment.
#pragma once

#include <filesystem>

#include "mesher/io/triangle_soup.h"
#include "mesher/plant/segmented_plant.h"

namespace liana {

/// Reads, validates, applies node transforms, and welds positions per domain. Domains come parents first; a
/// node without mesh only carries its transform. Throws Error{Input} naming file, node and what to do.
SegmentedPlant read_plant(const std::filesystem::path& path);

/// A glTF file, as which it turned out to be.
struct GltfPlant {
  bool segmented = false;
  SegmentedPlant plant;  ///< as read_plant gives it, if segmented
  TriangleSoup soup;     ///< all meshes of the scene in metres, labelled by node and material, if not
  uint64_t source_hash = 0;
};

/// A file is segmented when it says so (extras.liana), when meshes hang below meshes and at least half of
/// them are one connected surface, or when it is a single surface. `scale`: metres per unit of the file;
/// `ignore_hierarchy`: take any file as one merged mesh. Throws as read_plant.
GltfPlant read_gltf_plant(const std::string& bytes, const std::filesystem::path& path, double scale = 1,
                          bool ignore_hierarchy = false);

/// Writes the same form (names, parents, extras.liana), so that read_plant gives the plant back.
void write_plant(const SegmentedPlant& plant, const std::filesystem::path& path);

}  // namespace liana
