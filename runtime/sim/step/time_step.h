// One step of one plant: generalized-α, one linearised solve over the tree, and a net under it.
//
// Symbols: h substep (s); ρ∞ spectral radius at infinite frequency; gap distance between the two anchor
// points of a joint, over the length of the particle with its petiole. A step whose gap exceeds the limit is
// thrown away and redone from the same start with 2, 4, … 32 times as many substeps at ρ∞ = 0.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/shape_matching.h"
#include "runtime/sim/step/substep.h"

namespace liana {

/// A soft stem answers a steady pull by stretching: joints that open so slowly are let, up to a point. Chosen
/// by trial on the hanging stems of trust_hanging_test.cpp and the soak test; a joint law that is stiff along
/// the stem whatever it is across would make both needless.
struct SlowStretch {
  double a_step = 4e-3;  ///< of gap_scale(), that a gap may open in one step
  double most = 0.2;     ///< of gap_scale(), that it may be open in the end
};

struct StepOptions {
  double dt = 0.025;             ///< s; frequencies are as baked only when it equals plant.scheme.dt
  Vec3 gravity = {0, -9.81, 0};  ///< m/s²
  double gap_limit = 0.02;       ///< of gap_scale(); above it the step is redone, unless it opens slowly
  int most_redo_substeps = 32;   ///< per substep of the scheme; 1 switches the net off
  unsigned threads = 1;          ///< that share one plant, if it has some 400 particles or more
  SlowStretch slow = {};
};

struct StepReport {
  int solves = 0;          ///< linear solves spent, redone ones included
  int redone = 0;          ///< 0 in normal motion: how often this step was started again
  double gap = 0;          ///< largest joint gap of the accepted step, over its gap_scale()
  bool gap_held = true;    ///< false when even the finest redo ended above the limit
  int projected = 0;       ///< joints that were then closed by hand (see joint_projection.h)
  bool finite = true;      ///< false when no redo stayed finite: positions kept, velocities cleared
  bool calibrated = true;  ///< false when dt is not the one that the plant was calibrated for
};

/// Steps one plant: keep one per plant. Steps allocate nothing and start no thread, unless the plant's tree
/// changed since the last one (which is noticed), there are more springs or threads than ever, or the
/// workspace is too small. Deterministic; the same bits on any number of threads and on every processor.
class PlantStepper {
 public:
  /// external: one Wrench per particle, or empty. transient: contacts and grabs of this step, added to
  /// plant.anchors. workspace: the caller's, of its thread.
  StepReport step(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                  const StepOptions& options, StepWorkspace& workspace) noexcept {
    return step_from(plant, external, transient, 0, options, workspace);
  }
  /// The same, in a workspace of its own.
  StepReport step(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                  const StepOptions& options) noexcept {
    return step(plant, external, transient, options, own_);
  }

  /// Takes the step just taken again, from the same start, when `transient` only became longer: `known` of
  /// them were there before. The same as step(), bit for bit; supernodes without new springs are not
  /// eliminated again if `workspace` still holds that step's elimination.
  StepReport again(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                   size_t known, const StepOptions& options, StepWorkspace& workspace) noexcept {
    return step_from(plant, external, transient, known, options, workspace);
  }
  StepReport again(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                   size_t known, const StepOptions& options) noexcept {
    return again(plant, external, transient, known, options, own_);
  }

  /// The motion that the last step started from, and back to it.
  std::span<const Motion> start() const { return next_; }
  void take_back(Plant& plant) noexcept {
    plant.motion.swap(next_);
    gap_ = start_gap_;
  }

  /// What the substep runs on; the fastest that this processor has. For tests and benchmarks.
  void use(const lanes::Kernels& kernels) { solver_.use(kernels); }

  template <class Archive>
  void persist(Archive& a) {
    a(shape_matching_, gap_);
    // not state: solver_: the processor's kernels, an order that follows from the tree, working memory
    // not state: now_, next_, start_gap_, own_: working memory of one step
    // not state: kept_: for taking the same step again
    if constexpr (Archive::kReads) kept_ = 0;
  }

 private:
  struct Loads {
    std::span<const Wrench> external;
    std::span<const WorldSpring> transient;
  };
  StepReport step_from(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                       size_t known, const StepOptions& options, StepWorkspace& workspace) noexcept;
  void take_substeps(const Plant& plant, const Loads& loads, int finer, double gap_limit, bool only_stale,
                     const StepOptions& options, StepWorkspace& workspace, StepReport& report);
  void accept(Plant& plant, const Loads& loads, const StepOptions& options, StepReport& report);

  SubstepSolver solver_;
  ShapeMatchingStepper shape_matching_;  // for plants of that scheme
  double gap_ = 0, start_gap_ = 0;  // largest of the plant's present state, and where the last step began
  uint64_t kept_ = 0;               // names the last step's elimination, for again()
  MotionArray now_, next_;          // the plant's own state stays untouched until a step is accepted
  StepWorkspace own_;               // empty when all steps bring one
};

}  // namespace liana
