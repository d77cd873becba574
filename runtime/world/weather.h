// All the wind of a scene: the one everywhere, calmed near solids, and the air particles of its emitters.
#pragma once

#include <memory>

#include "runtime/wind/air/plant_coupling.h"
#include "runtime/wind/field/sheltered_wind.h"
#include "runtime/world/scene/scene.h"

namespace liana {

class Weather {
 public:
  /// Solids, those that stand still and those that move, must outlive it. Throws Error{Input}.
  Weather(const Scene& scene, std::span<const SdfObstacle* const> standing,
          std::span<const SdfObstacle* const> moving, double ground_height, unsigned threads);

  bool has_air() const { return air_ != nullptr; }
  /// Before the plants' steps, with all of them: moves the air and finds what it does to them.
  void advance(std::span<const PlantInWind> plants, double time, double dt);
  /// Appends the wind's dashpots of one plant and adds the air's pressure to its wrenches (left empty without
  /// air).
  void add_to(size_t index, const Plant& plant, double time, std::vector<WorldSpring>& springs,
              std::vector<Wrench>& wrenches) const;
  /// After the plants' steps: takes from the air what they got.
  void react(std::span<const PlantInWind> plants);

  const SphWind* air() const { return air_.get(); }
  double seconds() const { return seconds_; }  ///< spent in advance() and react() so far

  template <class Archive>
  void persist(Archive& a) {
    if (air_) a(*air_);
    // not state: open_, sheltered_: functions of the scene, place and time
    // not state: coupling_: made anew in every step
    // not state: seconds_: of a clock on the wall
  }

 private:
  std::unique_ptr<WindField> open_;  // null without a wind everywhere
  std::unique_ptr<ShelteredWind> sheltered_;
  std::unique_ptr<SphWind> air_;  // null without emitters
  std::unique_ptr<PlantCoupling> coupling_;
  double seconds_ = 0;
};

}  // namespace liana
