// In which order a tree of particles is eliminated: four at a time, and a cacheful at a time.
//
// Small subtrees, grouped into parts of a few hundred particles, each of which is finished before the next;
// then the top, what is left of the tree. On the way back first the top, then the parts. Between the two ways
// a part's poses and blocks are not needed: all parts share one workspace (a slot is a place in it), only the
// top has its own.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/lanes/step_view.h"

namespace liana {

/// A function of the tree alone, whatever its history.
class EliminationOrder {
 public:
  struct Part {
    uint32_t first, last;     ///< packs [first, last)
    uint32_t first_handover;  ///< the part's end where the next one's begin
  };
  /// What a part's subtree hands to the top: the block at slot `from` is to be added to the one at slot `to`.
  struct Handover {
    uint32_t from, to;
  };

  /// Makes the order anew when the number of particles changed, or when `changed`.
  void update(std::span<const Particle> particles, bool changed);

  /// Packs of up to four particles that do not depend on each other, children before parents. Within a part
  /// the farthest from the root go first, which needs the fewest packs that are possible ([Hu 1961]).
  /// Siblings go in an order of their own, so that what is summed in their parent does not depend, to the
  /// last bit, on what else is eliminated with them: trees of one plant do not see each other.
  std::span<const lanes::Pack> packs() const { return packs_; }
  std::span<const Part> parts() const { return parts_; }
  Part top() const { return top_; }
  std::span<const Handover> handovers() const { return handovers_; }
  /// Those of the parts from the begin-th to before the end-th.
  std::span<const Handover> handovers_of(size_t begin, size_t end) const {
    const auto at = [&](size_t part) {
      return part < parts_.size() ? parts_[part].first_handover : handovers_.size();
    };
    return handovers().subspan(at(begin), at(end) - at(begin));
  }

  size_t particles() const { return parent_.size(); }
  uint32_t part_of(ParticleId particle) const {
    return part_[particle.index()];
  }  ///< parts().size(): the top
  uint32_t slot_of(ParticleId particle) const { return slot_[particle.index()]; }
  uint32_t world_slot() const { return world_slot_; }  ///< below it the top, from the next on the workspace
  uint32_t pose_slots() const { return pose_slots_; }
  uint32_t block_slots() const { return block_slots_; }  ///< those for poses, then one per handover

  /// Whether the tree still is the one that the packs of a part were made for.
  bool still_holds(std::span<const Particle> particles, Part part) const;

 private:
  void divide();
  Part pack(std::span<const uint32_t> members);

  std::vector<uint32_t> parent_;  // particles() for a root
  std::vector<uint32_t> size_, depth_, waiting_, next_, part_, slot_, members_, start_;
  std::vector<uint32_t> younger_, youngest_;  // the sibling that hands on next; the last so far of a parent
  std::vector<uint32_t> first_, last_;        // per depth: queue of particles whose children are all done
  std::vector<lanes::Pack> packs_;
  std::vector<Part> parts_;
  Part top_{};
  std::vector<Handover> handovers_;
  uint32_t world_slot_ = 0, pose_slots_ = 0, block_slots_ = 0;
};

}  // namespace liana
