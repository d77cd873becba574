#include "runtime/world/world_obstacles.h"

#include <fmt/core.h>

#include "mesher/base/error.h"

namespace liana {

WorldObstacles::WorldObstacles(const Scene& scene) {
  if (!scene.solids) {
    if (scene.obstacles.empty()) return;
    throw Error(
        Error::Kind::Usage,
        fmt::format("{}: nobody has made solids of the scene's obstacles", scene.file.string()),
        "load_scene() or with_united_solids() make one of those that touch; with_separate_solids() leaves "
        "them as they are");
  }
  for (const SceneSolid& piece : scene.solids->pieces) {
    fields_.push_back(
        std::make_unique<SdfObstacle>(piece.mesh, SdfOptions{.voxel = piece.voxel, .sheet = piece.sheet}));
    fields_.back()->material = piece.contact_material;
    pointers_.push_back(fields_.back().get());
    if (!piece.moves_with) continue;
    require(motions_.size() + 1 == fields_.size(), "of a scene's solids those that move come first");
    motions_.push_back(scene.obstacles.at(*piece.moves_with).motion.value());
  }
}

void WorldObstacles::move(double from, double to) {
  for (size_t i = 0; i < motions_.size(); ++i) fields_[i]->place(motions_[i].between(from, to));
}

}  // namespace liana
