// A scene as a TOML file.
#pragma once

#include "runtime/world/scene/scene.h"

namespace liana {

/// Paths in the file are relative to it. Throws Error{Input} with file and line.
Scene read_scene(const std::filesystem::path& path);

}  // namespace liana
