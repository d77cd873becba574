#include "runtime/picture/draw_scene.h"

namespace liana {

BoundingBox bounding_box(const DrawScene& scene) {
  BoundingBox box;
  for (const DrawTube& tube : scene.tubes)
    for (size_t i = 0; i < tube.points.size(); ++i) box.add(tube.points[i], tube.radii[i]);
  for (const DrawLeaf& leaf : scene.leaves) {
    box.add(leaf.base);
    box.add(leaf.base + leaf.orientation * Vec3(0, leaf.length, 0), leaf.width / 2);
  }
  for (const DrawMesh& mesh : scene.meshes)
    for (const Vec3& position : mesh.mesh.positions) box.add(position);
  return box;
}

}  // namespace liana
