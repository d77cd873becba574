// In which order a tree of particles is eliminated: four at a time, and a cacheful at a time.
//
// Small subtrees, grouped into supernodes of a few hundred particles, each of which is finished before the
// next; then the top, what is left of the tree. On the way back first the top, then the others. Between the
// two ways a supernode's poses and blocks are not needed: all share one workspace (a slot is a place in it),
// only the top has its own.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/lanes/step_view.h"

namespace liana {

/// A function of the tree alone, whatever its history.
class EliminationOrder {
 public:
  struct Supernode {
    uint32_t first, last;       ///< packs [first, last)
    uint32_t first_extend_add;  ///< the supernode's end where the next one's begin
  };
  /// What a supernode's subtree adds to the top: the block at slot `from` is to be added to the one at slot
  /// `to`.
  struct ExtendAdd {
    uint32_t from, to;
  };

  /// Makes the order anew when the number of particles changed, or when `changed`.
  void update(std::span<const Particle> particles, bool changed);

  /// Packs of up to four particles that do not depend on each other, children before parents. Within a
  /// supernode the farthest from the root go first, which needs the fewest packs that are possible ([Hu
  /// 1961]). Siblings go in an order of their own, so that what is summed in their parent does not depend, to
  /// the last bit, on what else is eliminated with them: trees of one plant do not see each other.
  std::span<const lanes::Pack> packs() const { return packs_; }
  std::span<const Supernode> supernodes() const { return supernodes_; }
  Supernode top() const { return top_; }
  std::span<const ExtendAdd> extend_adds() const { return extend_adds_; }
  /// Those of the supernodes from the begin-th to before the end-th.
  std::span<const ExtendAdd> extend_adds_of(size_t begin, size_t end) const {
    const auto at = [&](size_t supernode) {
      return supernode < supernodes_.size() ? supernodes_[supernode].first_extend_add : extend_adds_.size();
    };
    return extend_adds().subspan(at(begin), at(end) - at(begin));
  }

  size_t particles() const { return parent_.size(); }
  uint32_t supernode_of(ParticleId particle) const {
    return supernode_[particle.index()];
  }  ///< supernodes().size(): the top
  uint32_t slot_of(ParticleId particle) const { return slot_[particle.index()]; }
  uint32_t world_slot() const { return world_slot_; }  ///< below it the top, from the next on the workspace
  uint32_t pose_slots() const { return pose_slots_; }
  uint32_t block_slots() const { return block_slots_; }  ///< those for poses, then one per ExtendAdd

  /// Whether the tree still is the one that the packs of a supernode were made for.
  bool still_holds(std::span<const Particle> particles, Supernode those) const;

 private:
  void divide();
  void measure_tree();
  uint32_t group_subtrees();
  uint32_t sort_members(uint32_t supernodes);
  void find_what_waits(std::span<const uint32_t> members);
  Supernode pack(std::span<const uint32_t> members);

  std::vector<uint32_t> parent_;  // particles() for a root
  std::vector<uint32_t> size_, depth_, waiting_, next_, supernode_, slot_, members_, start_;
  std::vector<uint32_t> younger_, youngest_;  // the sibling that hands on next; the last so far of a parent
  std::vector<uint32_t> first_, last_;        // per depth: queue of particles whose children are all done
  std::vector<lanes::Pack> packs_;
  std::vector<Supernode> supernodes_;
  Supernode top_{};
  std::vector<ExtendAdd> extend_adds_;
  uint32_t world_slot_ = 0, pose_slots_ = 0, block_slots_ = 0;
};

}  // namespace liana
