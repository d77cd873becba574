// Contacts of a plant with obstacles and the ground, as springs to the world for the next time step.
//
// A contact is made when a point is inside, or will be by the end of the step. Contacts that last remember
// where they hold on: what rests neither slides nor creeps.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/contact/contact_response.h"
#include "runtime/sim/contact/probes.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct ContactOptions {
  ContactMaterial ground = {};      ///< obstacles have their own
  double stiffness_ratio = 1000;    ///< normal stiffness over m/Δt²
  double least_stiffness = 5e3;     ///< N/m, of a stem's normal stiffness
  double softest_stem = 1.0 / 4;    ///< of stiffness_ratio m/Δt², where the joint bears no more
  double softest_blade = 1.0 / 16;  ///< the same for a blade
  double push_out_speed = 0.3;      ///< m/s, at which what is deep inside is moved out
  double buried = 1e-3;             ///< m inside, from which a particle that is new is left alone at a base
  bool remember_clearances = true;  ///< false: looks at every particle in every step, to the same effect
  ContactWeights weights = {};
};

struct ContactReport {
  size_t contacts = 0;         ///< springs made
  size_t exempt = 0;           ///< roots, and particles at a plant's base that were inside when first seen
  double max_penetration = 0;  ///< m, of the state looked at, without exempt particles
};

/// One per plant: it remembers which particles were made inside something, and the contacts of the present
/// step.
class Contacts {
 public:
  explicit Contacts(const ContactOptions& options = {}) : options_(options) {}

  /// Appends the contact springs for the next step of the plant's time scheme, from its present state: of
  /// what is inside, or will be if it goes on as it does.
  ContactReport gather(const Plant& plant, const CollisionScene& scene, std::vector<WorldSpring>& springs);

  /// After that step: appends springs for what is inside by more than `tolerance` (m) all the same and had
  /// none, for taking the step again from `before`. Returns how many.
  size_t gather_missed(const Plant& after, std::span<const Motion> before, const CollisionScene& scene,
                       double tolerance, std::vector<WorldSpring>& springs);

  /// Takes what was removed from the plant: what is known of the others moves with them. All of the above do
  /// it first; call it where the plant's removals are cleared.
  void take(const Plant& plant);

  /// Only looks: the report of the present state, with no springs.
  ContactReport measure(const Plant& plant, const CollisionScene& scene);

  template <class Archive>
  void persist(Archive& a) {
    a(slots_, exempt_, made_);
    // not state: options_: set once
    // not state: probes_, before_: working memory of one step
    // not state: clearances_: bounds that change no answer, learnt again
    if constexpr (Archive::kReads) clearances_ = Clearances();
  }

 private:
  struct Made {
    uint64_t key = 0;  // particle, probe, solid
    Vec3 normal = Vec3::Zero();
    StickAnchor anchor = {};
    bool operator<(const Made& other) const { return key < other.key; }
    template <class Archive>
    void persist(Archive& a) {
      a(key, normal, anchor);
    }
  };
  struct Touch;
  void notice_new_particles(const Plant& plant, const CollisionScene& scene);
  Touch touch_of(const Plant& plant, const Motion& motion, const Gap& found) const;
  void stiffen(const Plant& plant, const Gap& found, ContactPair& pair) const;
  WorldSpring respond(const Plant& plant, const Motion& motion, const Gap& found, Touch& touch,
                      StickAnchor& anchor) const;

  Clearances* clearances() { return options_.remember_clearances ? &clearances_ : nullptr; }

  ContactOptions options_;
  SlotCache slots_;
  Probes probes_;
  Clearances clearances_;
  std::vector<uint8_t> exempt_;      // per particle
  std::vector<Made> made_, before_;  // sorted: the contacts that have a spring in this step; in the last one
};

}  // namespace liana
