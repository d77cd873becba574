// From a scene as it is written to one that a world can be made of. The world itself sees no CGAL: what needs
// it happens here.
#pragma once

#include "runtime/world/scene/scene.h"

namespace liana {

/// The scene with the pieces of its obstacles, those that stand still and touch made one (touching_solids.h).
/// Throws Error{Input} naming the obstacle.
Scene with_united_solids(Scene scene);

/// read_scene() and that.
Scene load_scene(const std::filesystem::path& path);

}  // namespace liana
