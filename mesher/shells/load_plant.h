// The front door: any file that holds a plant becomes a segmented plant.
#pragma once

#include <filesystem>
#include <string>

#include "mesher/plant/segmented_plant.h"

namespace liana {

enum class Unit { Auto, Metre, Centimetre, Millimetre };
enum class UpAxis { Auto, Y, Z };

struct LoadOptions {
  Unit unit =
      Unit::Auto;  ///< Auto: metres for glTF, centimetres for MTG, else guessed from the plant's sizes
  UpAxis up = UpAxis::Auto;       ///< Auto: z for PLY and MTG, else y
  bool ignore_hierarchy = false;  ///< take a segmented file as one merged mesh too
};

/// OBJ, PLY, glTF and GLB meshes, MTG and graph skeletons, told apart by content, then by name. A file that
/// says itself what grows from what is taken as is; else the mesh is split into shells, each is found to be a
/// branch or a leaf, and a hierarchy is looked for. SegmentedPlant::notes says what was found, guessed and
/// mended, and Domain::parent_confidence how sure it is. Throws Error{Input} naming file and place.
SegmentedPlant load_plant(const std::filesystem::path& path, const LoadOptions& options = {});

/// Whether load_plant would try to read a file with this name and beginning.
bool is_plant_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace liana
