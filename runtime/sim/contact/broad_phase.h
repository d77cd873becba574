// Which particles of plants are near each other: a list of pairs that lasts for several steps.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/contact/aabb_tree.h"
#include "runtime/sim/contact/contact_cache.h"
#include "runtime/sim/contact/narrow_phase.h"

namespace liana {

struct BroadPhaseOptions {
  double margin = 12e-3;  ///< m that the list allows all round
  double list_steps = 6;  ///< steps at the present velocity that it allows for
};

/// One per world. The list holds every pair of particles whose boxes may overlap in a step, but for those
/// that the collision filter takes out: that share a joint or nearly so, and blades with their own branch.
class BroadPhase {
 public:
  struct Body {
    Outline outline;
    float way;  ///< m, that it goes in a step at most
    ParticleName name;
  };
  struct Pair {
    uint32_t a, b;    ///< bodies, a < b
    uint32_t cached;  ///< into the contact cache, or kNone

    template <class Archive>
    void persist(Archive& archive) {
      archive(a, b, cached);
    }
  };
  static constexpr uint32_t kNone = ~0u;

  explicit BroadPhase(const BroadPhaseOptions& options = {}) : options_(options) {}

  /// Looks where all particles are now. Pairs that were listed keep their number in the cache; all are listed
  /// anew when particles came or went.
  void update(std::span<const Plant* const> plants, std::span<const CachedContact> cache);
  /// The next update() lists all anew.
  void forget_all() { sizes_.clear(); }

  std::vector<Pair>& pairs() { return pairs_; }
  const Body& body(uint32_t number) const { return bodies_[number]; }
  size_t bodies() const { return bodies_.size(); }
  size_t listed() const { return moved_count_; }  ///< bodies whose neighbours were looked up by update()
  /// Whether a body was not there before update(), and whether it may touch another within the step.
  bool is_new(const Body& body) const {
    return body.name.plant >= sizes_.size() || body.name.particle >= sizes_[body.name.plant];
  }
  bool may_touch(const Pair& pair, float apart) const;
  /// After all pairs were dealt with: nobody is new any more.
  void end(std::span<const Plant* const> plants);

  template <class Archive>
  void persist(Archive& a) {
    a(sizes_, kin_, listed_, pairs_);
    // not state: options_: set once
    // not state: tree_, known_: made anew before they are asked
    // not state: bodies_, boxes_, moved_, moved_count_: working memory of one step
  }

 private:
  struct Kin {
    uint32_t parent, grandparent;  // particles of the same plant, or kNone
    BranchId branch;

    template <class Archive>
    void persist(Archive& a) {
      a(parent, grandparent, branch);
    }
  };
  struct Known {
    PairName pair;
    uint32_t cached;
    bool operator<(const Known& other) const { return pair < other.pair; }
  };
  void look_at(std::span<const Plant* const> plants);
  void find_moved(std::span<const Plant* const> plants);
  void list_moved(std::span<const Plant* const> plants);
  void take_out_moved(std::span<const CachedContact> cache);
  void offer(uint32_t a, uint32_t b);
  bool filtered_out(uint32_t a, uint32_t b) const;

  BroadPhaseOptions options_;
  AabbTree tree_;              // over listed_
  std::vector<size_t> sizes_;  // of the plants that the list was made for
  std::vector<Body> bodies_;   // by plant and particle
  std::vector<Kin> kin_;       // of bodies, for the list
  std::vector<Aabb> boxes_;    // of now, with the way of one step
  std::vector<Aabb> listed_;   // what the list looks at: boxes with a margin
  std::vector<Pair> pairs_;
  std::vector<uint8_t> moved_;  // per body
  size_t moved_count_ = 0;
  std::vector<Known> known_;  // of the pairs that are listed anew; sorted
};

/// m/s, of a particle's ends as it turns.
double turning_speed(const Particle& particle, const Motion& motion);

}  // namespace liana
