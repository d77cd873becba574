// [Haedrich17]'s own scheme, oriented shape matching, as the reference for the paper's behaviour: selected by
// TimeScheme::solver (`solver = "shape-matching"` in a scene).
//
// Symbols: x_p, q_p predicted pose; a bar means the rest state; a group is {parent, self, children}; A its
// moment matrix, R the rotation in A = R S, c its centre of mass; x_g goal; s stiffness; φ attachment.
//
// What it cannot do is the reason for PlantStepper: its frequencies come from the number of particles, the
// time step and the number of passes, never from the material. Nothing but masses, sizes and the rest shape
// is read here.
#pragma once

#include <span>
#include <vector>

#include "runtime/sim/model/plant.h"

namespace liana {

struct StepOptions;
struct StepReport;
struct Wrench;

/// §4.3 of the paper; its own numbers.
struct ShapeMatchingOptions {
  int passes = 1;             ///< over all groups, per step
  double stiffness = 1;       ///< s of a particle that is full-grown
  double youngest = 0.2;      ///< share of s that a particle appears with
  double maturing_time = 10;  ///< seconds, until it has all of s
};

/// Steps one plant: keep one per plant. A particle counts as young when it was appended between two steps;
/// those that the first step finds, and all after some were taken away, count as full-grown. Deterministic;
/// allocates nothing unless the number of particles changed.
class ShapeMatchingStepper {
 public:
  explicit ShapeMatchingStepper(const ShapeMatchingOptions& options = {}) : options_(options) {}

  /// As PlantStepper::step(). Of a wrench only the force counts: Eq. 1 has no other term. A spring moves the
  /// particle as Eq. 5 does, with φ = k h² / (m + c h + k h²): what one implicit step of that spring does to
  /// a free particle. Reports no joint gap, for there are no joints, and never `calibrated`.
  StepReport step(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
                  const StepOptions& options) noexcept;

  template <class Archive>
  void persist(Archive& a) {
    a(age_);
    // not state: options_: set once
    // not state: rest_position_, rest_orientation_: laid out anew in every step
    // not state: position_, orientation_, ellipsoid_, group_, goal_: working memory of one step
  }

 private:
  /// Sums over a group, then what it wants.
  struct Group {
    double mass;
    Vec3 centre, rest_centre;  ///< sums of m x and m x̄ first
    Mat3 moment;               ///< A; R once it is matched
    double weight;             ///< w of its target positions
  };

  struct Goal {
    Vec3 position;  ///< Σ w x_t
    double weight;  ///< Σ w
  };

  void find_rest(const Plant& plant);
  void age(size_t particles, double dt);
  bool substep(Plant& plant, std::span<const Wrench> external, std::span<const WorldSpring> transient,
               double h, const Vec3& gravity);
  void attach(const Plant& plant, const WorldSpring& spring, double h);
  void match(const Plant& plant);

  ShapeMatchingOptions options_;
  std::vector<Vec3> rest_position_;     // x̄, of the whole plant standing on its root
  std::vector<Quat> rest_orientation_;  // R̄
  std::vector<Vec3> position_;          // x_p
  std::vector<Quat> orientation_;       // q_p
  std::vector<Mat3> ellipsoid_;         // A_i + m x x̄ᵀ
  std::vector<Group> group_;            // per particle
  std::vector<Goal> goal_;
  std::vector<double> age_;  // s
};

/// The rotation R in the polar decomposition A = R S that is nearest to `guess`; `guess` itself for A = 0.
Quat polar_rotation(const Mat3& A, const Quat& guess);

}  // namespace liana
