// One linearised implicit solve over the tree of one plant.
//
// Balanced at t + (1−α_f) h, with x_f = x̂ + k₁ a₁, v_f = v̂ + k₂ a₁ (x̂, v̂ the prediction with a₁ = 0):
//   [ (1−α_m) M + k₂ D + k₁ K ] a₁ = F − α_m M a₀ − D v̂ − f(x̂),   k₁ = (1−α_f) β h²,   k₂ = (1−α_f) γ h
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/elimination_order.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/step_workspace.h"

namespace liana {

/// What acts on one particle from outside, at its centre of mass. World frame.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N·m
};

/// The numbers and loads that one substep is taken with.
struct Substep {
  double h;  ///< s
  GeneralizedAlpha method;
  std::span<const Wrench> external;
  Vec3 gravity;               ///< m/s²
  unsigned threads;           ///< that may share the plant
  Vec3 world = Vec3::Zero();  ///< m: how far the world is off its place
  bool only_stale = false;    ///< the workspace holds all else
  double position_rate = (1 - method.alpha_f) * method.beta * h * h;  ///< k₁, s²
  double velocity_rate = (1 - method.alpha_f) * method.gamma * h;     ///< k₂, s
};

struct SubstepOutcome {
  double gap = 0;             ///< largest joint gap over its gap_scale()
  bool finite = true;         ///< every number of the new state is
  bool tree_changed = false;  ///< nothing was done: the plant's tree is no longer the one that was prepared
};

/// Keep one per plant.
class SubstepSolver {
 public:
  /// Before the substeps of a step: the order of elimination (made anew when the number of particles changed,
  /// or when `changed`), and which springs belong where. `transient` must live until the last of them.
  void prepare(const Plant& plant, std::span<const WorldSpring> transient, bool changed);
  /// Marks what springs from the known-th of `transient` on act upon: all that an elimination with the others
  /// has to do again.
  void mark_stale(std::span<const WorldSpring> transient, size_t known);

  SubstepOutcome take(const Plant& plant, const Substep& step, std::span<const Motion> from,
                      std::span<Motion> to, StepWorkspace& workspace);

  size_t particles() const { return order_.particles(); }  ///< that it was prepared for
  void use(const lanes::Kernels& kernels) { kernels_ = &kernels; }

 private:
  class Shares;
  bool leaves_to_root(const Plant& plant, const Shares& shares);
  void eliminate(lanes::StepView view, const EliminationOrder::Supernode& those) const;
  SubstepOutcome root_to_leaves(const Shares& shares);
  void add_loads(const Substep& step, const EliminationOrder::Supernode& those, uint32_t number,
                 const lanes::StepView& view) const;

  const lanes::Kernels* kernels_ = &lanes::best_kernels();
  EliminationOrder order_;
  std::vector<const WorldSpring*> springs_;  // anchors and transient ones, by supernode
  std::vector<uint32_t> first_spring_;       // of each supernode and the top
  std::vector<uint8_t> stale_;               // per supernode
};

}  // namespace liana
