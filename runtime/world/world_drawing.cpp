#include "runtime/world/world_drawing.h"

#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/picture/air_drawing.h"

namespace liana {

void add_world(const World& world, bool names, DrawScene& scene) {
  const Garden& garden = world.garden();
  for (size_t i = 0; i < garden.size(); ++i)
    add_plant(garden[i].plant, garden.origin_of(garden[i]).look, {.names = names}, scene);
  for (const SceneObstacle& obstacle : world.scene().obstacles) {
    scene.meshes.push_back({obstacle.mesh, obstacle.color, obstacle.bricks, obstacle.name});
    if (!obstacle.motion) continue;
    const ObstaclePose pose = obstacle.motion->between(world.time(), world.time());
    for (Vec3& p : scene.meshes.back().mesh.positions) p = pose.rotation * p + pose.position;
  }
  scene.to_sun = world.scene().to_sun.normalized();
  if (const SphWind* air = world.weather().air(); air && world.scene().wind.show_air)
    add_air(air->air(), scene);
}

DrawScene drawing_of(const World& world, bool names) {
  DrawScene scene;
  add_world(world, names, scene);
  return scene;
}

Camera camera_of(const World& world) {
  Camera camera;
  const std::optional<SceneCamera>& wanted = world.scene().camera;
  if (!wanted) {
    camera.frame(bounding_box(drawing_of(world)), 16.0 / 9);
    return camera;
  }
  const Vec3 back = wanted->eye - wanted->target;
  camera.pivot = wanted->target;
  camera.distance = back.norm();
  camera.azimuth = fixed::atan2(back.x(), back.z());
  camera.elevation = fixed::asin(back.y() / back.norm());
  camera.field_of_view = wanted->vertical_angle;
  return camera;
}

}  // namespace liana
