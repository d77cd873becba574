// One branch by itself: its chain of particles, the parent held, the mass of everything that grows from it
// lumped on the particles it grows from. The offline stage defines a domain's frequency on exactly this body;
// calibration and verification use it too.
//
// Symbols: K = Σ Jᵀ C J joint stiffness at rest, M masses and inertias, K φ = ω₁² M φ the lowest mode.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/step/joints.h"

namespace liana {

/// Per particle: mass (kg) of all other branches that grow from it, with everything that grows from those.
std::vector<double> carried_masses(const Plant& plant);

/// Working memory is kept between uses: building another chain of the same size allocates nothing.
class HeldChain {
 public:
  /// Takes the branch's particles at rest. carried: one mass per particle of the plant.
  void build(const Plant& plant, BranchId branch, std::span<const double> carried);

  /// Smallest eigenvalue ω₁² (1/s²) by inverse iteration on two vectors. A held chain is statically
  /// determinate, so K⁻¹ is one sweep of wrenches from tip to root and one of strains back: exact at any
  /// ratio of stiffnesses.
  double lowest_eigenvalue();
  int iterations() const { return iterations_; }

  /// φ of the last lowest_eigenvalue(): per particle (translation, rotation), world axes, M-normalised.
  std::span<const Vec6> mode() const { return mode_; }

  /// The chain as a plant of its own, at rest, without gravity's loads; scheme and branch as in the plant it
  /// is from.
  Plant plant() const;

 private:
  void start_vectors();
  void apply_mass(int column);
  void apply_compliance(int column);

  TimeScheme scheme_;
  Branch branch_;
  ParticleArray particles_;
  std::vector<BodyPose> rest_;
  std::vector<JointStrain> joint_;
  Eigen::Matrix<double, Eigen::Dynamic, 2> X_, MX_;
  std::vector<Vec6> mode_;
  int iterations_ = 0;
};

}  // namespace liana
