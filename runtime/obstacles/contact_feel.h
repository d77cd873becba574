// How a touched surface answers, and what a lasting contact remembers.
#pragma once

#include <algorithm>
#include <cmath>

#include "mesher/base/types.h"

namespace liana {

/// Both in [0, 1], zero the lowest and one the highest response ([Haedrich17] §5.2).
struct ContactFeel {
  double friction = 0.6;  ///< Coulomb's coefficient: a push of the normal force times this holds
  double elasticity = 0;  ///< speed of leaving over that of arriving, along the normal

  bool operator==(const ContactFeel&) const = default;
};

/// Sliding goes over into holding, and back, with one step's delay.
struct Grip {
  bool holds = false;
  Vec3 on_a = Vec3::Zero();  ///< where the particle holds on, in its own frame, m
  Vec3 on_b = Vec3::Zero();  ///< the same in the frame of what it touches, m

  template <class Archive>
  void persist(Archive& a) {
    a(holds, on_a, on_b);
  }
};

/// What friction does in a step: a tangential spring with this stretch, or a dashpot.
struct FrictionAnswer {
  Vec3 stretch = Vec3::Zero();  ///< m, tangential, to where it holds on; with the contact's own stiffness
  double dashpot = 0;           ///< N·s/m; > 0 while it slides
};

/// Coulomb's law for the next step. slip: from where the contact holds on to where it is now, m; velocity and
/// acceleration: of the slip; all tangential. stiffness: of the tangential spring at rest, N/m; limit:
/// friction times normal force, N; mass: kg, what a step of dt moves at least. Decides whether `grip` goes on
/// holding.
///
/// A dashpot of limit/|v| is Coulomb's force for the velocity v that the step ends with; v is foreseen.
inline FrictionAnswer friction_answer(Grip& grip, const Vec3& slip, const Vec3& velocity,
                                      const Vec3& acceleration, double stiffness, double limit, double mass,
                                      double dt) {
  constexpr double kSlow = 2e-3;  // m/s
  if (grip.holds) {
    const double pull = stiffness * slip.norm();
    if (pull <= limit) return {-slip, 0};
    grip.holds = false;
    return {Vec3::Zero(), limit / std::max(1e-5, velocity.norm() + (pull - limit) * dt / mass)};
  }
  const double speed = velocity.norm(), next = (velocity + dt * acceleration).norm();
  if (speed < kSlow && next <= speed) {
    grip.holds = true;
    return {};
  }
  return {Vec3::Zero(), limit / std::max(1e-5, next)};
}

}  // namespace liana
