// What happened in a world since its start, in numbers.
#pragma once

#include <algorithm>
#include <optional>

#include "runtime/sim/contact/contact_step.h"
#include "runtime/wind/air/sph_wind.h"

namespace liana {

/// Seconds of work since the start, summed over threads.
struct PhaseSeconds {
  double growth = 0, collision = 0, physics = 0;
  double touching = 0;  ///< plants with plants; wall clock
  double wind = 0;      ///< air particles; wall clock

  PhaseSeconds operator-(const PhaseSeconds& o) const {
    return {growth - o.growth, collision - o.collision, physics - o.physics, touching - o.touching,
            wind - o.wind};
  }
};

/// Of one plant's steps since its start.
struct PlantReport {
  size_t contacts = 0;          ///< with obstacles and the ground, in the last step
  double max_penetration = 0;   ///< m, deepest that any particle ever was in an obstacle or the ground
  size_t redone_steps = 0;      ///< steps that the solver took again with finer substeps
  size_t contact_passes = 0;    ///< taken again because a contact showed only at the step's end
  size_t projected_joints = 0;  ///< closed by joint projection where the finest substeps did not hold them
  size_t lost_steps = 0;        ///< steps that did not stay finite and were stopped
  double growth_seconds = 0, collision_seconds = 0, physics_seconds = 0;  ///< of work

  void note(const ContactStepReport& done) {
    contacts = done.contacts.contacts;
    max_penetration = std::max(max_penetration, done.contacts.max_penetration);
    contact_passes += static_cast<size_t>(done.passes - 1);
    redone_steps += done.step.redone > 0;
    projected_joints += static_cast<size_t>(done.step.projected);
    lost_steps += !done.step.finite;
    collision_seconds += done.collision_seconds;
  }
  /// All but the contacts of the last step.
  void add(const PlantReport& o) {
    max_penetration = std::max(max_penetration, o.max_penetration);
    redone_steps += o.redone_steps, contact_passes += o.contact_passes;
    projected_joints += o.projected_joints, lost_steps += o.lost_steps;
    growth_seconds += o.growth_seconds, collision_seconds += o.collision_seconds;
    physics_seconds += o.physics_seconds;
  }

  template <class Archive>
  void persist(Archive& a) {
    a(contacts, max_penetration, redone_steps, contact_passes, projected_joints, lost_steps);
    // not state: growth_seconds, collision_seconds, physics_seconds: of a clock on the wall
  }
};

/// How many parts came off, and what became of them.
struct SeveringReport {
  size_t broken = 0, shed = 0, cut = 0;  ///< branches and leaves that broke off, parts cut off
  size_t removed = 0;                    ///< taken away: after their time at rest, or blown out of the scene

  template <class Archive>
  void persist(Archive& a) {
    a(broken, shed, cut, removed);
  }
};

/// What happened since the start.
struct WorldReport : PlantReport, SeveringReport {
  size_t steps = 0, particles = 0, anchors = 0;
  size_t plant_contacts = 0;         ///< pairs of particles that touched in the last step
  size_t grown_together = 0;         ///< pairs that overlap since they were made, and do not push each other
  double max_overlap = 0;            ///< m, of two plant parts that touch
  std::optional<SphWindReport> air;  ///< absent without emitters
  size_t detached = 0, asleep = 0;   ///< parts that are there now, and how many of them lie still
  PhaseSeconds seconds;
};

}  // namespace liana
