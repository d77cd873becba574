// Plants lose parts: cuts, breaks, and what becomes of the parts.
#pragma once

#include "runtime/world/grabs.h"

namespace liana {

class Severing {
 public:
  explicit Severing(const SceneDetached& fate) : fate_(fate) {}

  Detachment cut(Garden& garden, size_t plant, ParticleId particle);

  /// After a plant's step: notes which of its joints are overloaded.
  void look_for_fractures(PlantInstance& plant) const;
  /// Takes off what is held by these joints. Calls detached(const Detachment&) for each part.
  template <class Detached>
  void break_overloaded(Garden& garden, const Detached& detached) {
    const size_t count = garden.size();  // what comes off now is looked at after its first step
    for (size_t plant = 0; plant < count; ++plant)
      while (const std::optional<Fracture> worst = next_fracture(garden[plant]))
        detached(break_off(garden, plant, worst->at));
  }

  /// After a part's step of dt (s): its roots die; when it lies still for a while it stops and sleeps.
  void let_rest(PlantInstance& part, double dt) const;
  /// Takes away parts that have slept for their time or are far away, unless they are held.
  void remove_parts(Garden& garden, Grabs& grabs, double dt);

  void add_to(WorldReport& report) const;

  template <class Archive>
  void persist(Archive& a) {
    a(done_, departed_);
    // not state: fate_: of the scene
  }

 private:
  std::optional<Fracture> next_fracture(PlantInstance& plant) const;
  Detachment break_off(Garden& garden, size_t plant, ParticleId particle);
  Detachment take_off(Garden& garden, size_t plant, ParticleId particle) const;

  SceneDetached fate_;
  SeveringReport done_;
  PlantReport departed_;  // what happened to parts that were taken away
};

}  // namespace liana
