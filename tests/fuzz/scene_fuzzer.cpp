// read_scene on any bytes, beside an empty bake, so that scenes may name one: everything in its range and
// every index of something that is there, or an Error.
#include "mesher/base/error.h"
#include "runtime/world/scene/scene_file.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const liana::FuzzFile file(data, size, "fuzz.toml"), bake(nullptr, 0, "a.bake");
  try {
    const liana::Scene scene = liana::read_scene(file.path());
    liana::require(scene.time_step > 0 && scene.seconds >= 0 && scene.gravity.allFinite(), "a finite world");
    liana::require(!scene.plants.empty() || !scene.climbers.empty(), "something that grows");
    liana::require(scene.wind.velocity.allFinite(), "a finite wind");
    for (const liana::SceneImpulse& impulse : scene.impulses)
      liana::require(impulse.plant < scene.plants.size(), "a plant to strike");
    const auto is_there = [&](const liana::ScenePoint& point) {
      return point.index < (point.climber ? scene.climbers.size() : scene.plants.size());
    };
    for (const liana::SceneCut& cut : scene.cuts) liana::require(is_there(cut.where), "something to cut");
    for (const liana::SceneGrab& grab : scene.grabs)
      liana::require(is_there(grab.where) && !grab.path.empty(), "something to hold, and where to");
    for (const liana::SceneObstacle& obstacle : scene.obstacles)
      for (const liana::Triangle& t : obstacle.mesh.triangles)
        for (const uint32_t v : t) liana::require(v < obstacle.mesh.positions.size(), "valid corners");
  } catch (const liana::Error&) {
  }
  return 0;
}
