// The plants of a world: those of the scene, and behind them the parts that came off.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/sim/contact/plant_contacts.h"
#include "runtime/sim/model/topology.h"
#include "runtime/wind/air/plant_coupling.h"
#include "runtime/world/plant_instance.h"
#include "runtime/world/scene/scene.h"

namespace liana {

/// A part came off a plant, and is the last one now.
struct Detachment {
  size_t plant, part;   ///< places in the garden
  Remap change;         ///< of the plant's slots
  DetachedFrom origin;  ///< of the part's particles and branches
};

class Garden {
 public:
  /// Appends what the plants' calibration says to the notes. Throws Error.
  Garden(const Scene& scene, std::vector<std::string>& notes);

  size_t size() const { return plants_.size(); }
  PlantInstance& operator[](size_t i) { return *plants_[i]; }
  const PlantInstance& operator[](size_t i) const { return *plants_[i]; }
  const PlantOrigin& origin_of(const PlantInstance& plant) const { return origins_[plant.origin]; }

  /// At the start of a step: every cache of slots takes what plants lost since the last one.
  void take_removals();
  /// Lets a plant grow by dt (s) from where it is, at its own speed.
  void grow(size_t plant, std::span<const SdfObstacle* const> solids, const Vec3& to_sun, double dt);
  /// Adds what plants that touch each other do to each other to their springs.
  void touch();
  /// All of them, for the wind. Valid until plants grow, come or go.
  std::span<const PlantInWind> in_wind();
  /// How many plants are so large, and awake, that threads had better share one.
  size_t large_ones() const;

  /// Takes off a particle and all that grows from it, as a new plant of this name.
  Detachment detach(size_t plant, ParticleId particle, std::string name);
  /// Takes a part away; those behind it move up.
  void remove(size_t part);

  void add_to(WorldReport& report) const;

  template <class Archive>
  void persist(Archive& a) {
    size_t count = plants_.size();
    a(count);
    if constexpr (Archive::kReads) have_parts_for(count);
    for (auto& plant : plants_) a(*plant);
    a(touching_, touched_, max_overlap_);
    // not state: origins_, contact_weights_: of the scene
    // not state: touching_seconds_: of a clock on the wall
    // not state: all_plants_, all_springs_, in_wind_: where things are
  }

 private:
  /// As many plants, those of the scene among them; of parts that are new, all is still to be read.
  void have_parts_for(size_t count);

  std::vector<PlantOrigin> origins_;  // of the scene's plants
  std::vector<std::unique_ptr<PlantInstance>> plants_;
  ContactWeights contact_weights_;
  PlantContacts touching_;
  PlantContactReport touched_;
  double max_overlap_ = 0, touching_seconds_ = 0;  // m, s
  std::vector<const Plant*> all_plants_;
  std::vector<std::vector<WorldSpring>*> all_springs_;
  std::vector<PlantInWind> in_wind_;
};

}  // namespace liana
