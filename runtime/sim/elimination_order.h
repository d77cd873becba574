// In which order a tree of particles is eliminated, four at a time.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/lanes/step_view.h"
#include "runtime/sim/plant.h"

namespace liana {

/// Packs of up to four particles that do not depend on each other, children before parents. The farthest from
/// the root go first, which needs the fewest packs that are possible ([Hu 1961]: ⌈n/4⌉ of them, or as many as
/// the longest chain and the tree's shape ask for). A function of the tree alone, whatever the history of it.
class EliminationOrder {
 public:
  /// Makes the order anew when the tree changed since the last call; says whether it did.
  bool update(std::span<const Particle> particles);

  std::span<const lanes::Pack> packs() const { return packs_; }

 private:
  void build();

  std::vector<uint32_t> parent_;  // count for a root
  std::vector<uint32_t> depth_, waiting_, next_;
  std::vector<uint32_t> first_, last_;  // per depth: queue of particles whose children are all done
  std::vector<lanes::Pack> packs_;
};

}  // namespace liana
