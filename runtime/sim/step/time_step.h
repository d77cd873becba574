// One step of one plant: generalized-α, one linearised solve over the tree, and a net under it.
//
// Symbols: h substep (s); ρ∞ spectral radius at infinite frequency; gap distance between the two anchor
// points of a joint, over the length of the particle with its petiole. A step whose gap exceeds the limit is
// thrown away and redone from the same start with 2, 4, … 32 times as many substeps at ρ∞ = 0.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/step/elimination_order.h"
#include "runtime/sim/step/shape_matching.h"

namespace liana {

/// What acts on one particle from outside, at its centre of mass. World frame.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N·m
};

struct StepOptions {
  double dt = 0.025;             ///< s; frequencies are as baked only when it equals plant.scheme.dt
  Vec3 gravity = {0, -9.81, 0};  ///< m/s²
  double gap_limit = 0.02;       ///< of gap_scale(); above it the step is redone, unless it opens slowly
  int most_redo_substeps = 32;   ///< per substep of the scheme; 1 switches the net off
  unsigned threads = 1;          ///< that share one plant, if it has some 400 particles or more
};

struct StepReport {
  int solves = 0;          ///< linear solves spent, redone ones included
  int redone = 0;          ///< 0 in normal motion: how often this step was started again
  double gap = 0;          ///< largest joint gap of the accepted step, over its gap_scale()
  bool gap_held = true;    ///< false when even the finest redo ended above the limit
  int reseated = 0;        ///< joints that were then closed by hand (see reseat.h)
  bool finite = true;      ///< false when no redo stayed finite: positions kept, velocities cleared
  bool calibrated = true;  ///< false when dt is not the one that the plant was calibrated for
};

/// Steps one plant. Owns the working memory: keep one per plant. Steps allocate nothing unless the plant's
/// tree changed since the last one, which is noticed. Deterministic; the same bits on any number of threads
/// and on every processor.
class PlantStepper {
 public:
  /// external: one Wrench per particle, or empty. transient: contacts and grabs of this step, added to
  /// plant.anchors.
  StepReport step(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                  const StepOptions& options) noexcept {
    return step_from(plant, external, transient, 0, options);
  }

  /// Takes the step just taken again, from the same start, when `transient` only became longer: `known` of
  /// them were there before. The same as step(), bit for bit; parts of the tree without new springs are not
  /// eliminated again.
  StepReport again(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                   size_t known, const StepOptions& options) noexcept {
    return step_from(plant, external, transient, known, options);
  }

  /// The motion that the last step started from, and back to it.
  const std::vector<Motion>& start() const { return next_; }
  void take_back(Plant& plant) noexcept {
    plant.motion.swap(next_);
    gap_ = start_gap_;
  }

  /// What the substep runs on; the fastest that this processor has. For tests and benchmarks.
  void use(const lanes::Kernels& kernels) { kernels_ = &kernels; }

  template <class Archive>
  void persist(Archive& a) {
    a(shape_matching_, gap_);
    // not state: kernels_: the processor's
    // not state: order_: a function of the tree, made anew when that is another
    // not state: springs_, first_spring_, stale_, now_, next_, start_gap_: working memory of one step
    // not state: kept_: for taking the same step again
    if constexpr (Archive::kReads) kept_ = 0;
  }

 private:
  struct Substep;  // the numbers and loads that one substep is taken with
  enum class Outcome { Finite, NotFinite, TreeChanged };

  StepReport step_from(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                       size_t known, const StepOptions& options) noexcept;
  Outcome substep(const Plant& plant, const Substep& step, const std::vector<Motion>& from,
                  std::vector<Motion>& to, bool some, double& gap) noexcept;
  void sort_springs(const Plant& plant, std::span<const WorldSpring> transient) noexcept;
  void add_loads(const Substep& step, const EliminationOrder::Part& part, uint32_t number,
                 const lanes::StepView& view) noexcept;

  const lanes::Kernels* kernels_ = &lanes::best_kernels();
  EliminationOrder order_;
  std::vector<const WorldSpring*> springs_;  // anchors and transient ones, by part
  std::vector<uint32_t> first_spring_;       // of each part and the top
  ShapeMatchingStepper shape_matching_;      // for plants of that scheme
  std::vector<uint8_t> stale_;               // per part, when not all need be eliminated
  double gap_ = 0, start_gap_ = 0;  // largest of the plant's present state, and where the last step began
  uint64_t kept_ = 0;               // the step whose elimination a thread's memory still holds
  std::vector<Motion> now_, next_;  // the plant's own state stays untouched until a step is accepted
};

}  // namespace liana
