// What a substep computes with and then forgets: poses, blocks and records of the plant at hand.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/large_pages.h"
#include "runtime/sim/step/elimination_order.h"

namespace liana {

/// Working memory of PlantStepper::step(). Whoever steps plants one after the other gives the same one to all
/// of them, so that it stays in the cache; two steps at the same time need two. It only ever grows.
class StepWorkspace {
 public:
  static constexpr unsigned kMostShares = 16;  ///< threads that one plant can be shared by

  /// Of one share of a plant; see step_view.h.
  struct Space {
    std::vector<double> pose, block;

    double* block_of(uint32_t slot) { return &block[size_t{lanes::kBlockStride} * slot]; }
    /// Room for the order; the world's pose at `world_position`, unturned and at rest, and no load handed on
    /// by any supernode, or by those that are marked in `stale` if it is not empty.
    void prepare(const EliminationOrder& order, const Vec3& world_position, std::span<const uint8_t> stale);
    void copy_top_poses(const Space& from, const EliminationOrder& order);
  };

  /// One Space for each share, and the records.
  void fit(const EliminationOrder& order, unsigned shares);
  std::span<Space> spaces(unsigned shares) { return {spaces_.data(), shares}; }
  double* record() { return record_.data(); }

  /// Makes all of them as large as the largest: no plant that one of them served makes another grow.
  static void level(std::span<StepWorkspace> workspaces);

  /// Names the elimination that it holds from now on; never 0. Whoever uses it next forgets it.
  uint64_t hold();
  void forget() { held_ = 0; }
  bool holds(uint64_t elimination) const { return elimination != 0 && elimination == held_; }

 private:
  std::vector<Space> spaces_;
  std::vector<double, LargePages<double>> record_;
  uint64_t held_ = 0;
};

}  // namespace liana
