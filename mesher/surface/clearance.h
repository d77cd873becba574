// A quick proof that a surface does not pass through itself.
#pragma once

#include "mesher/base/mesh.h"

namespace liana {

/// True only if the mesh is a consistently oriented manifold without flat triangles and every two triangles
/// meet at most in the vertex or edge they share, by a margin that rounding cannot bridge. False says
/// nothing: ask self_intersects(), which takes ten times as long. Meant for up to some 10,000 triangles.
bool surely_clear(const Mesh& mesh);

}  // namespace liana
