// Contacts between plants, and of a plant with itself, as pairs of springs for the next time step.
//
// Stems are capsules, blades are ellipsoids (meeting.h). Both particles of a pair are drawn to where the two
// would meet if only they moved: the lighter one goes most of the way. At rest and for free particles the two
// pushes are equal and opposite; plants are solved one by one, so in between a branch that is held moves less
// than foreseen and the pair closes over a few steps.
#pragma once

#include <span>
#include <vector>

#include "runtime/obstacles/contact_feel.h"
#include "runtime/sim/contact/box_pairs.h"
#include "runtime/sim/contact/meeting.h"
#include "runtime/sim/model/plant.h"

namespace liana {

struct PlantContactOptions {
  ContactFeel feel;
  double stiffness_ratio = 10;      ///< normal stiffness of a light touch over reduced mass/Δt²
  double deepest = 5;               ///< times Meeting::soft: what is deeper, or an impact, is no stiffer
  double push_out_speed = 0.5;      ///< m/s, at which what is deep inside is moved out
  double blades_apart_speed = 0.1;  ///< m/s, the same for a blade
  double margin = 12e-3;            ///< m that lists of neighbours allow all round
  double list_steps = 6;            ///< steps at the present velocity that they allow for
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
  explicit PlantContacts(const PlantContactOptions& options = {}) : options_(options) {}

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
    a(slots_, sizes_, kin_, listed_, candidates_, memory_);
    // not state: options_: set once
    // not state: tree_, forgotten_: made anew before they are asked
    // not state: bodies_, boxes_, next_memory_, moved_, moved_count_: working memory of one step
  }

 private:
  struct Body {
    Outline outline;
    float way;  // m, that it goes in a step at most
    uint32_t plant, particle;
    uint64_t name() const { return uint64_t{plant} << 32 | particle; }
  };
  struct Kin {
    uint32_t parent, grandparent;  // particles of the same plant, or kNone
    BranchId branch;
    template <class Archive>
    void persist(Archive& a) {
      a(parent, grandparent, branch);
    }
  };
  struct Memory {   // of a pair that touches
    uint64_t a, b;  // plant << 32 | particle
    Vec3 normal;    // from b to a
    bool exempt;
    Grip grip;
    auto key() const { return std::pair(a, b); }
    template <class Archive>
    void persist(Archive& archive) {
      archive(a, b, normal, exempt, grip);
    }
  };
  struct Candidate {
    uint32_t a, b;
    uint32_t memory;  // into memory_, or kNone
    template <class Archive>
    void persist(Archive& archive) {
      archive(a, b, memory);
    }
  };
  static constexpr uint32_t kNone = ~0u;

  void look_at(std::span<const Plant* const> plants);
  void find_moved(std::span<const Plant* const> plants);
  void list_moved(std::span<const Plant* const> plants);
  bool near_kin(uint32_t a, uint32_t b) const;
  void touch(Candidate& candidate, std::span<const Plant* const> plants,
             std::span<std::vector<WorldSpring>* const> springs, PlantContactReport& report);

  PlantContactOptions options_;
  std::vector<SlotCache> slots_;  // per plant
  BoxPairs tree_;                 // over listed_
  std::vector<size_t> sizes_;     // of the plants that the list was made for
  std::vector<Body> bodies_;      // by plant and particle
  std::vector<Kin> kin_;          // of bodies, for the list
  std::vector<FlatBox> boxes_;    // of now, with the way of one step
  std::vector<FlatBox> listed_;   // what the list looks at: boxes with a margin
  std::vector<Candidate> candidates_;
  std::vector<Memory> memory_, next_memory_;
  std::vector<uint8_t> moved_;  // per body
  size_t moved_count_ = 0;
  std::vector<std::pair<std::pair<uint64_t, uint64_t>, uint32_t>> forgotten_;  // key, into memory_; sorted
};

}  // namespace liana
