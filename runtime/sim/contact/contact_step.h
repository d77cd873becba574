// A time step that ends outside of solids: step, look, and step again with the contacts that were missed.
#pragma once

#include "runtime/sim/contact/contacts.h"
#include "runtime/sim/step/time_step.h"

namespace liana {

struct ContactStepOptions {
  double tolerance = 5e-4;  ///< m inside a solid that does not make a step be taken again
  int most_passes = 4;      ///< times a step is taken at most
};

struct ContactStepReport {
  StepReport step;               ///< of the pass that was kept
  ContactReport contacts;        ///< penetration is that of the state before the step
  int passes = 0;                ///< how often the step was taken
  int solves = 0;                ///< of all passes
  double collision_seconds = 0;  ///< wall clock, spent looking for contacts
};

/// PlantStepper::step() with contacts. springs: wind, grabs; the contacts are appended. Keep one per plant.
/// Like that it allocates nothing, unless there are more contacts than ever and more than particles.
class ContactStepper {
 public:
  explicit ContactStepper(const ContactOptions& contacts = {}, const ContactStepOptions& options = {})
      : contacts_(contacts), options_(options) {}

  ContactStepReport step(Plant& plant, const CollisionScene& scene, std::span<const Wrench> external,
                         std::vector<WorldSpring>& springs, const StepOptions& options,
                         StepWorkspace& workspace);
  /// The same, in a workspace of its own.
  ContactStepReport step(Plant& plant, const CollisionScene& scene, std::span<const Wrench> external,
                         std::vector<WorldSpring>& springs, const StepOptions& options) {
    return step(plant, scene, external, springs, options, own_);
  }

  /// Takes what was removed from the plant, as step() does first.
  void take(const Plant& plant) { contacts_.take(plant); }

  Contacts& contacts() { return contacts_; }

  template <class Archive>
  void persist(Archive& a) {
    a(contacts_, stepper_);
    // not state: options_: set once
    // not state: own_: working memory of one step
  }

 private:
  Contacts contacts_;
  ContactStepOptions options_;
  PlantStepper stepper_;
  StepWorkspace own_;  // empty when all steps bring one
};

}  // namespace liana
