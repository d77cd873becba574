// What a world looks like now.
#pragma once

#include "runtime/picture/camera.h"
#include "runtime/world/world.h"

namespace liana {

/// Appends plants, obstacles and, if the scene wants them, air particles; with `names`, every branch and leaf
/// is named. Sets the sun.
void add_world(const World& world, bool names, DrawScene& scene);

DrawScene drawing_of(const World& world, bool names = false);

/// The scene's camera, or one that sees everything.
Camera camera_of(const World& world);

}  // namespace liana
