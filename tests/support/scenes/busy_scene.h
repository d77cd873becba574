// A small scene in which everything happens: two trees that break, a climber on a wall, gusts, air particles.
#pragma once

#include "materials/bake/bake_file.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/obstacles/box_mesh.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/climber_scene.h"
#include "tests/support/scratch_folder.h"

namespace liana::test {

/// Its bake is written to the folder, which the scene's worlds read while they are made.
inline Scene busy_scene(const ScratchFolder& folder) {
  Bake bake = synthetic_bake({.branches = 4, .twigs = 2, .leaves = 2, .height = 2});
  bake.law = ivy_like_law();
  for (auto& [name, group] : bake.law.groups) group.modulus_of_rupture = name == "leaf" ? 1.5e7 : 4e6;
  for (BakedDomain& domain : bake.domains) domain.default_frequency = domain.material.frequency;
  const std::filesystem::path file = folder / "tree.bake";
  write_bake(bake, file);

  Scene scene;
  scene.plants = {{file, {-1, 0, 0.5}, 0, 1}, {file, {1, 0, 0.5}, 0.7, 0.3}};
  SceneClimber climber;
  climber.bake = file;
  climber.position = {0, 0, 0.1};
  climber.growth_speed = 4;
  climber.max_particles = 300;
  scene.climbers = {climber};
  SceneObstacle wall;
  wall.name = "wall";
  wall.mesh = box_mesh({-2, 0, -0.2}, {2, 3, 0});
  scene.obstacles = {wall};
  scene.wind.velocity = {3, 0, -1};
  EmitterParameters emitter;
  emitter.center = {-2, 1, 1};
  emitter.radius = 0.5;
  emitter.speed = 8;
  SphWindParameters air;
  air.low = {-2.5, 0, 0}, air.high = {2.5, 3, 2.5};
  air.emitters = {emitter};
  scene.wind.air = air;
  scene.detached.remove_after = 1;
  return with_united_solids(std::move(scene));
}

}  // namespace liana::test
