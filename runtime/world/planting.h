// Plants of a scene as they stand at its beginning.
#pragma once

#include <memory>

#include "runtime/world/plant_instance.h"
#include "runtime/world/scene/scene.h"

namespace liana {

struct Planted {
  std::unique_ptr<PlantInstance> instance;
  PlantOrigin origin;
};

/// From its bake. Appends what calibration changed or could not serve to the notes. Throws Error.
Planted plant_baked(const Scene& scene, const ScenePlant& entry, std::vector<std::string>& notes);

/// A seed, with the law of a bake or of a species. Throws Error.
Planted plant_climber(const Scene& scene, const SceneClimber& entry, uint64_t seed,
                      std::vector<std::string>& notes);

}  // namespace liana
