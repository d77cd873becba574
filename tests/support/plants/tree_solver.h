// Linear-time direct solve of a symmetric system on a tree: one 6×6 block per node, one joint per node to its
// parent.
//
//   minimise over a:  Σ_i ½ a_iᵀ A_i a_i − b_iᵀ a_i  +  Σ_joints ½ (T_c a_c − T_p a_p)ᵀ W (T_c a_c − T_p a_p)
//
// Symbols: a_i motion of a node, (translation of its centre, rotation), world axes; T(r) = [1 −[r]×; 0 1]
// moves a motion from the centre to the joint's point at lever r; W = diag(W_s, W_b) joint stiffness; Ā =
// T_c⁻ᵀ A T_c⁻¹ the inertia of a node and all that hangs on it, seen at its joint; b̄ = T_c⁻ᵀ b.
//
// Eliminating a node passes its *inertia* up, S = Ā − Ā (Ā+W)⁻¹ Ā, not the Schur complement W − W (Ā+W)⁻¹ W
// of the same value, which cancels when the joint is much stiffer than what hangs on it.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "runtime/sim/step/joints.h"

namespace liana {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// The joint of a node to its parent, as the solver sees it. World axes.
struct TreeJoint {
  Vec3 from_self;    ///< r_c: from the node's centre to the joint's point
  Vec3 from_parent;  ///< r_p: from the parent's centre to the same point (unused for a root, whose parent
                     ///< rests)
  Mat3 shear;        ///< W_s
  Mat3 bend;         ///< W_b
};

/// Nodes are numbered parents first. Use: reset every node; then, last node to first, complete it and
/// eliminate() it; then, first to last, substitute() it. Nothing is allocated but by resize().
class TreeSolver {
 public:
  void resize(size_t nodes) { nodes_.resize(nodes); }
  size_t size() const { return nodes_.size(); }

  /// Sets A_i = diag(mass, mass, mass, inertia) and b_i.
  void reset(size_t node, double mass, const Mat3& inertia, const Vec3& force, const Vec3& torque) noexcept;
  /// A_i += T(lever)ᵀ [stiffness 0; 0 0] T(lever): a spring at a point of the node.
  void add_point(size_t node, const Vec3& lever, const Mat3& stiffness) noexcept;
  /// b_i += (force, torque).
  void add_load(size_t node, const Vec3& force, const Vec3& torque) noexcept;

  /// Passes a node on to its parent (parent < node, or kRoot). All its children must have been eliminated.
  void eliminate(size_t node, uint32_t parent, const TreeJoint& joint) noexcept;
  /// The motion of an eliminated node, once its parent's is known.
  const Vec6& substitute(size_t node) noexcept;

  static constexpr uint32_t kRoot = ParticleId::kNone;

 private:
  static constexpr int kPacked = 21;  // lower triangle, row by row
  struct alignas(64) Node {
    double inertia[kPacked];  // A_i, then Ā
    double factor[kPacked];   // Ā + W = L D Lᵀ: L below the diagonal, 1/D on it
    double load[6];           // b_i, then b̄
    Vec3 from_self, from_parent;
    uint32_t parent;
    Vec6 motion;
  };
  std::vector<Node> nodes_;
};

}  // namespace liana
