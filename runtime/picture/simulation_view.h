// What the editor window needs of a simulation.
#pragma once

#include "runtime/picture/draw_scene.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct SimulationStats {
  double time = 0;  ///< s, simulated
  size_t steps = 0, particles = 0, anchors = 0;
  double growth_ms = 0, collision_ms = 0, physics_ms = 0,
         wind_ms = 0;       ///< of the last step
  size_t redone_steps = 0;  ///< so far; 0 in normal motion
};

class Simulation {
 public:
  virtual ~Simulation() = default;
  virtual void step() = 0;
  virtual double time_step() const = 0;  ///< s
  virtual Vec3 gravity() const = 0;      ///< m/s²
  virtual void draw(DrawScene& scene) const = 0;
  virtual size_t plant_count() const = 0;
  virtual const Plant& plant(size_t index) const = 0;
  /// Holds a point of one plant until cleared; the spring is kept over steps and replaced by the next call.
  virtual void set_grab(size_t plant, const WorldSpring& spring) = 0;
  virtual void clear_grab() = 0;
  /// Cuts a particle and all that grows from it off. Other particles and plants may be renumbered.
  virtual void cut(size_t plant, ParticleId particle) = 0;
  virtual SimulationStats stats() const = 0;
};

}  // namespace liana
