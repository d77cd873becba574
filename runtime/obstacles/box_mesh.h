// Boxes are meshes too: walls, floors and test bodies go the same way as any other obstacle.
#pragma once

#include "mesher/geometry/mesh.h"

namespace liana {

/// A closed axis-parallel box of 8 vertices and 12 triangles. Throws Error{Input} unless low < high in every
/// axis.
Mesh box_mesh(const Vec3& low, const Vec3& high);

}  // namespace liana
