#include "runtime/world/scene/scene_solids.h"

#include <fmt/core.h>

#include "mesher/base/error.h"
#include "runtime/obstacles/pieces.h"

namespace liana {
namespace {

void add_pieces(const SceneObstacle& obstacle, size_t index, SceneSolids& moving, SceneSolids& standing,
                SceneSolids& sheets) {
  const Pieces pieces = pieces_of(obstacle.mesh);
  const double thickness = obstacle.thickness.value_or(kSheetThickness);
  if (pieces.sheet_count > 0 && !obstacle.thickness)
    moving.notes.push_back(fmt::format(
        "obstacle '{}': {} of its {} pieces have no inside and count as sheets {} mm thick "
        "('thickness' sets it)",
        obstacle.name, pieces.sheet_count, pieces.solids.size() + pieces.sheet_count, 1e3 * thickness));
  SceneSolid piece;
  piece.contact_material = obstacle.contact_material;
  if (obstacle.motion) piece.moves_with = index;
  for (const Mesh& solid : pieces.solids) {
    piece.mesh = solid;
    (obstacle.motion ? moving : standing).pieces.push_back(piece);
  }
  if (pieces.sheet_count == 0) return;
  piece.mesh = pieces.sheets;
  piece.sheet = thickness;
  (obstacle.motion ? moving : sheets).pieces.push_back(piece);
}

}  // namespace

SceneSolids pieces_of_obstacles(const Scene& scene) {
  SceneSolids all, standing, sheets;
  for (size_t i = 0; i < scene.obstacles.size(); ++i) {
    const SceneObstacle& obstacle = scene.obstacles[i];
    try {
      add_pieces(obstacle, i, all, standing, sheets);
    } catch (const Error& error) {
      throw Error(error.kind,
                  fmt::format("{}: obstacle '{}': {}", scene.file.string(), obstacle.name, error.what()),
                  error.hint);
    }
  }
  for (SceneSolids* more : {&standing, &sheets})
    all.pieces.insert(all.pieces.end(), std::make_move_iterator(more->pieces.begin()),
                      std::make_move_iterator(more->pieces.end()));
  return all;
}

Scene with_separate_solids(Scene scene) {
  scene.solids = pieces_of_obstacles(scene);
  return scene;
}

}  // namespace liana
