// Contacts between plants, and of a plant with itself, as pairs of springs for the next time step.
//
// Stems are capsules, blades are ellipsoids (narrow_phase.h). Both particles of a pair are drawn to where the
// two would meet if only they moved: the lighter one goes most of the way. At rest and for free particles the
// two pushes are equal and opposite; plants are solved one by one, so in between a branch that is held moves
// less than foreseen and the pair closes over a few steps.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/contact/broad_phase.h"
#include "runtime/sim/contact/contact_cache.h"
#include "runtime/sim/contact/contact_response.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct PlantContactOptions {
  ContactMaterial material = {};
  double stiffness_ratio = 10;  ///< normal stiffness of a light touch over reduced mass/Δt²
  double softest = 0.25;        ///< of that, where the joints bear no more
  double deepest = 5;           ///< times ContactGeometry::soft: what is deeper, or an impact, is no stiffer
  double push_out_speed = 0.5;  ///< m/s, at which what is deep inside is moved out
  double blades_apart_speed = 0.1;  ///< m/s, the same for a blade
  double apart = 5e-4;              ///< m, beyond which an exempt pair counts as come apart
  BroadPhaseOptions broad_phase = {};
  ContactWeights weights = {};
};

struct PlantContactReport {
  size_t contacts = 0;     ///< pairs that got springs
  size_t exempt = 0;       ///< pairs that overlapped when first seen and have not come apart since
  size_t candidates = 0;   ///< pairs in the list
  size_t listed = 0;       ///< particles whose neighbours were looked up anew
  double max_overlap = 0;  ///< m, of the state looked at, without exempt pairs

  template <class Archive>
  void persist(Archive& a) {
    a(contacts, exempt, candidates, listed, max_overlap);
  }
};

/// One per world: it keeps the list of neighbours, and what pairs that touch remember.
class PlantContacts {
 public:
  explicit PlantContacts(const PlantContactOptions& options = {})
      : options_(options), broad_phase_(options.broad_phase) {}

  /// Appends to springs[k] what plants[k] needs in its next step. All plants must share their time step.
  PlantContactReport gather(std::span<const Plant* const> plants,
                            std::span<std::vector<WorldSpring>* const> springs);

  /// Takes what was removed from plants[plant]: what is known of the others moves with them. gather() does it
  /// first; call it where the plant's removals are cleared.
  void take(size_t plant, const Plant& of);
  /// plants[plant] is gone, and those after it moved up.
  void forget(uint32_t plant);

  template <class Archive>
  void persist(Archive& a) {
    a(slots_, broad_phase_, cache_);
    // not state: options_: set once
    // not state: next_cache_: working memory of one step
  }

 private:
  struct Body;
  struct Masses {
    double reduced, share_a;  // kg; of the way that a goes
  };
  void touch(BroadPhase::Pair& pair, std::span<const Plant* const> plants,
             std::span<std::vector<WorldSpring>* const> springs, PlantContactReport& report);
  void keep(BroadPhase::Pair& pair, const CachedContact& contact);
  Masses masses_of(const Body& a, const Body& b, const ContactGeometry& met) const;
  void stiffen(const Body& a, const Body& b, const ContactGeometry& met, const Masses& masses,
               ContactPair& pair) const;

  PlantContactOptions options_;
  BroadPhase broad_phase_;
  std::vector<SlotCache> slots_;  // per plant
  std::vector<CachedContact> cache_, next_cache_;
};

}  // namespace liana
