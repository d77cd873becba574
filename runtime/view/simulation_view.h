// What the editor needs of a simulated world.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/sim/plant.h"
#include "runtime/view/draw_scene.h"

namespace liana {

struct SimulationStats {
  double time = 0;  ///< s, simulated
  size_t steps = 0, particles = 0, branches = 0, anchors = 0;
  std::vector<std::pair<std::string, double>> stage_ms;  ///< of the last step: "physics", "growth", ...
};

class Simulation {
 public:
  virtual ~Simulation() = default;
  virtual void step() = 0;
  virtual double time_step() const = 0;                  ///< s
  virtual void draw(DrawScene& scene) const = 0;         ///< appends to the scene, sets its sun
  virtual std::vector<const Plant*> plants() const = 0;  ///< valid until the next step
  /// From now on each step pulls at a particle of plants()[plant]; replaces the grab before.
  virtual void set_grab(size_t plant, const WorldSpring& grab) = 0;
  virtual void clear_grab() = 0;
  virtual SimulationStats stats() const = 0;
};

}  // namespace liana
