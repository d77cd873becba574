// A plant that lives in a world, or a part that came off one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/growth/climber.h"
#include "runtime/picture/plant_drawing.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/model/breaking.h"
#include "runtime/world/world_report.h"

namespace liana {

/// What all that came off one plant of the scene share with it. Never changes.
struct PlantOrigin {
  PlantLook look;
  std::vector<std::string> domains;  ///< of its bake: names by DomainId
  double growth_speed = 1;
  uint64_t source = 0;  ///< hash of the bake or species that it was made from
};

/// A part that broke or was cut off: it falls, comes to rest and then sleeps.
struct DetachedPart {
  static constexpr double kStillFor = 1;  // s, after which it sleeps
  double seconds = 0, still = 0;          // s since it came off, at rest
  std::vector<Vec3> lay;                  // m, where its particles were when it last moved

  bool asleep() const { return still >= kStillFor; }

  template <class Archive>
  void persist(Archive& a) {
    a(seconds, still, lay);
  }
};

struct PlantInstance {
  explicit PlantInstance(const ContactOptions& contacts) : stepper(contacts) {}

  Plant plant;
  ContactStepper stepper;
  std::optional<Climber> climber;  ///< of a plant that grows
  size_t origin = 0;               ///< which plant of the scene it is or came off, baked ones first
  std::optional<DetachedPart> detached;
  PlantReport report;
  std::vector<WorldSpring> springs;  ///< wind, grabs and contacts of the step
  std::vector<Wrench> wrenches;      ///< the air's pressure
  std::vector<uint8_t> growing;      ///< per particle, of a climber
  std::vector<Fracture> fractures;   ///< of the last step

  bool asleep() const { return detached && detached->asleep(); }
  void wake() {
    if (detached) detached->still = 0;
  }

  template <class Archive>
  void persist(Archive& a) {
    a(plant, stepper, climber, origin, detached, report);
    // not state: springs, wrenches, growing: made anew in every step before they are used
    // not state: fractures: there only from a plant's step to the end of the world's
    if constexpr (Archive::kReads) springs.clear(), wrenches.clear(), growing.clear(), fractures.clear();
  }
};

}  // namespace liana
