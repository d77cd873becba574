// The [wind] table of a scene file.
#pragma once

#include "materials/law/toml_table.h"
#include "runtime/world/scene/scene.h"

namespace liana {

/// Reads [wind], [wind.air] and every [[wind.emitter]]. Throws Error{Input} with file and line.
SceneWind read_scene_wind(const TomlTable& table, uint64_t scene_seed);

}  // namespace liana
