// The time step written plainly: one particle after the other, Eigen throughout, no net. What the lanes of
// PlantStepper are checked against and timed against.
#pragma once

#include "runtime/sim/step/joints.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/tree_solver.h"

namespace liana::test {

class ReferenceStepper {
 public:
  /// One step of plant.scheme.substeps parts. False when something is not finite; the plant is left in it.
  bool step(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
            const StepOptions& options);

  double gap() const { return gap_; }  ///< of the last step
  TreeSolver& solver() { return solver_; }

 private:
  struct Substep;

  void predict(const Plant& plant, const Substep& step);
  void add_springs(std::span<const WorldSpring> springs, const Substep& step);
  void eliminate(const Plant& plant, const Substep& step);
  bool advance(Plant& plant, const Substep& step);

  TreeSolver solver_;
  std::vector<BodyPose> pose_;  // at the moment where forces are balanced, between two substeps
  MotionArray next_;
  double gap_ = 0;
};

}  // namespace liana::test
