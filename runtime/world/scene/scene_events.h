// What is done to the plants of a scene: [[impulse]], [[cut]], [[grab]], and [detached] for what becomes of
// it.
#pragma once

#include "materials/law/toml_table.h"
#include "runtime/world/scene/scene.h"

namespace liana {

/// Reads all of them; the scene's plants and climbers must be known. Throws Error{Input} with file and line.
void read_scene_events(const TomlTable& table, Scene& scene);

}  // namespace liana
