#include "runtime/app/scene/scene_preparation.h"

#include "runtime/app/scene/touching_solids.h"
#include "runtime/world/scene/scene_file.h"
#include "runtime/world/scene/scene_solids.h"

namespace liana {

Scene with_united_solids(Scene scene) {
  SceneSolids all = pieces_of_obstacles(scene);
  const auto stands = [](const SceneSolid& piece) { return !piece.moves_with && piece.sheet == 0; };
  const auto first = std::find_if(all.pieces.begin(), all.pieces.end(), stands);
  const auto last = std::find_if_not(first, all.pieces.end(), stands);
  std::vector<SceneSolid> standing(std::make_move_iterator(first), std::make_move_iterator(last));
  unite_touching(standing);
  all.pieces.insert(all.pieces.erase(first, last), std::make_move_iterator(standing.begin()),
                    std::make_move_iterator(standing.end()));
  scene.solids = std::move(all);
  return scene;
}

Scene load_scene(const std::filesystem::path& path) {
  return with_united_solids(read_scene(path));
}

}  // namespace liana
