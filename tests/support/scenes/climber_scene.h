// A wall, a seed before it, an ivy-like law, and the loop that lets it grow and sway.
#pragma once

#include <memory>
#include <vector>

#include "runtime/growth/climber.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/wind/field/wind_field.h"

namespace liana {

/// Frequencies and damping of the order of ivy's; 0.7 Hz at 1 m.
SpeciesLaw ivy_like_law();

/// A 5 m wide, 3 m high wall of 0.2 m with its face at z = 0, and a seed on the ground 0.12 m before its
/// middle.
class ClimberScene {
 public:
  explicit ClimberScene(const ClimberParameters& parameters = {}, uint64_t seed = 1);

  void step(const WindField* wind = nullptr);
  void run(double seconds, const WindField* wind = nullptr);

  std::span<const SdfObstacle* const> obstacles() const { return {&wall_pointer_, 1}; }
  CollisionScene collision() const { return {obstacles(), 0.0}; }

  struct Seconds {
    double growth = 0, wind = 0, physics = 0;  ///< wall clock
    double collision = 0;                      ///< the part of physics that looks for contacts
  };

  SdfObstacle wall;
  Plant plant;
  Climber climber;
  ContactStepper stepper;
  double growth_speed = 1;  ///< growth seconds per second
  double time = 0;          ///< s
  GrowthReport growth;      ///< of the last step
  size_t out_of_range = 0, recalibrated = 0, redone = 0, contact_springs = 0,
         passes = 0;                          ///< sums over all steps
  double max_penetration = 0, max_speed = 0;  ///< over all steps, m and m/s
  bool sound = true;                          ///< every step finite, every gap held
  Seconds seconds;

 private:
  const SdfObstacle* wall_pointer_ = &wall;
  std::vector<WorldSpring> springs_;
};

}  // namespace liana
