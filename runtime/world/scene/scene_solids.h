// The obstacles of a scene as the pieces that contacts can work with: solids, and sheets for what has no
// inside.
#pragma once

#include "runtime/world/scene/scene.h"

namespace liana {

/// Every closed piece of every obstacle as a solid of its own. Throws Error{Input} naming the obstacle.
SceneSolids pieces_of_obstacles(const Scene& scene);

/// The scene with these pieces as they are: where solids touch, the faces between them remain, and a particle
/// that came between them may be led out the wrong way. with_united_solids()
/// (runtime/app/scene/scene_preparation.h) makes one of those that touch; it needs CGAL.
Scene with_separate_solids(Scene scene);

}  // namespace liana
