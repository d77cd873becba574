// The lowest eigenpairs of K x = λ M x: a few by inverse iteration, many by Lanczos.
#pragma once

#include <span>

#include "modal/elements/assembly.h"

namespace liana {

struct EigenOptions {
  int modes = 2;            ///< at most half of the free dof are given: beyond, they are the mesh's own
  double shift = 0;         ///< σ > 0, dimensionless: factor K + σ M, for bodies that can move rigidly
  double tolerance = 3e-5;  ///< on the residual; the eigenvalue's relative error is about its square
  int max_iterations = 100;
};

/// Dimensionless, in the system's units.
struct EigenResult {
  Eigen::VectorXd eigenvalues;  ///< ascending
  NodalVectors vectors;         ///< 3 nodes × modes, M-normalised
  /// Rayleigh-Ritz on the three static deflections under uniform acceleration: the lowest bending about
  /// either axis, then stretch, whatever modes (torsion, plate modes) lie between them. Direction: mean
  /// displacement, a unit column.
  Vec3 sway_eigenvalues = Vec3::Zero();
  Mat3 sway_directions = Mat3::Identity();
  uint32_t dof = 0;
  int iterations = 0;
  /// Max over modes of how far x is from an eigenvector, by the M-norm: |λ K⁻¹ M x − x|. Of the inverse
  /// iteration that of the last x but one times the contraction of that measure in the last step.
  double residual = 0;
  bool converged = false;
};

/// held: per dof (3 a node), 1 if it is fixed at zero. Up to two modes by inverse_iteration(), more by
/// lanczos(). Throws Error{Input} when K + σ M is not positive definite.
EigenResult lowest_eigenpairs(const System& system, std::span<const uint8_t> held,
                              const EigenOptions& options);

}  // namespace liana
