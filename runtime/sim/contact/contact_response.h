// How what touches answers: one response for plants that touch obstacles, the ground, and each other.
//
// Symbols: n unit normal, from b to a; δ depth, −gap (m); k normal stiffness (N/m); x₁, v₁ place and velocity
// along n at the end of a step; t where the spring draws to; τ settling time (s); α_m, α_f, γ of the
// generalized-α method ([Chung & Hulbert 1993]); share the part of a mutual approach that one side goes.
//
// With the force k(t − x₁) − k τ v₁ of the end of the step and k ≫ m/Δt², the step ends with
// (x₁ − t) + τ v₁ = 0: the point comes to the surface and stays there. The time step takes spring forces at
// n+1−α_f, so target and its velocity are mixed with the present ones by α_f, which leaves (1−α_f) times that
// force.
//
// An impact with restitution ends with a velocity instead. The acceleration a₁ that gives it lingers: a force
// F makes (1−α_m) a₁ = F/m now, and γΔt a₁ of the FΔt/m that the velocity gains in the end.
#pragma once

#include "runtime/obstacles/contact_material.h"
#include "runtime/sim/model/plant.h"

namespace liana {

/// Where a lasting contact holds on. Sticking goes over into sliding, and back, with one step's delay.
struct StickAnchor {
  bool holds = false;
  Vec3 on_a = Vec3::Zero();  ///< in the particle's own frame, m
  Vec3 on_b = Vec3::Zero();  ///< the same in the frame of what it touches, m

  template <class Archive>
  void persist(Archive& a) {
    a(holds, on_a, on_b);
  }
};

/// Numbers of the response that no material gives. Chosen by trial; tests/tools/fit_contacts.cpp prints what
/// each of them does to fence.toml, wall.toml and moving_cubes.toml.
struct ContactWeights {
  /// m a step: an approach by that much takes a whole step off the settling time. A contact that is met
  /// gently is closed as if over `gentlest` steps, so that it does not knock; an impact within `hardest` of
  /// one.
  double impact = 4e-3;
  double gentlest = 1.25, longest = 1, hardest = 0.25;  ///< of Δt
  /// A contact that settles ends a step about τ|v| above the surface, on its way down: let go then, it would
  /// fall and come again for ever. So it lasts while `linger` times what it comes nearer by would close it.
  double linger = 3;
  /// m/s, beyond which restitution shows: less than half of what gravity gives in a step of 25 ms, so that
  /// nothing bounces that only settles.
  double bounce_speed = 0.1;
  /// m/s: what slides no faster, and is not getting faster, sticks.
  double stick_speed = 2e-3;

  template <class Archive>
  void persist(Archive& a) {
    a(impact, gentlest, longest, hardest, linger, bounce_speed, stick_speed);
  }
};

/// A touching pair, as the response sees it. World frame; b may be immovable.
struct ContactPair {
  Vec3 normal;           ///< n
  double gap;            ///< m; < 0 while they overlap
  Vec3 velocity;         ///< of a's point relative to b's, m/s
  Vec3 acceleration;     ///< the same, m/s²
  double mass = 0;       ///< kg that a push moves at least
  double stiffness = 0;  ///< k
  double stick = 0;      ///< N/m, across n, while it holds
  double load = 0;       ///< N: the normal force that friction goes by
  double way = 0;        ///< m along n, that the pair shall part by in the step
  bool slides = false;   ///< without friction, whatever the material
  ContactMaterial material = {};

  double approach() const { return velocity.dot(normal); }  ///< m/s, < 0 while they come nearer
  /// m that they come nearer by in a step, as they move now; never above 0.
  double coming(double dt) const;
};

/// Whether the pair needs springs in the coming step. lasting: it had them in the last one. What bounces
/// leaves by itself.
bool touches(const ContactPair& pair, bool lasting, double dt, const ContactWeights& weights);

/// What friction does in a step: a tangential spring with this stretch, or a dashpot.
struct FrictionAnswer {
  Vec3 stretch = Vec3::Zero();  ///< m, tangential, to where it holds on
  double dashpot = 0;           ///< N·s/m; > 0 while it slides
};

/// Coulomb's law for the next step. slip: from where the contact holds on to where it is now, tangential, m.
/// stiffness: of the tangential spring at rest, N/m. Decides whether `anchor` goes on holding.
///
/// A dashpot of limit/|v| is Coulomb's force for the velocity v that the step ends with; v is foreseen.
FrictionAnswer friction_answer(StickAnchor& anchor, const Vec3& slip, const ContactPair& pair,
                               double stiffness, double dt, const ContactWeights& weights);

/// One body of a pair, with what the response makes it follow.
struct ContactSide {
  ParticleId particle;
  Vec3 on_particle;  ///< m, particle's frame: where it is pushed
  Vec3 point;        ///< m, world: the same
  Vec3 velocity;     ///< m/s, of that point
  double share = 1;  ///< of the way, in (0, 1]; the stiffness is divided by it
  double sign = 1;   ///< of n: −1 for b
};

/// The response of one pair in one step: the springs that both of its sides get.
class ContactResponse {
 public:
  /// slip: from where the contact holds on to where it is now, m. common: the velocity of the contact itself,
  /// m/s, which both sides take on: that of an immovable b's surface, the mean weighted by masses for two
  /// that give way.
  ContactResponse(const ContactPair& pair, StickAnchor& anchor, const Vec3& slip, const Vec3& common,
                  const TimeScheme& scheme, const ContactWeights& weights);
  WorldSpring spring(const ContactSide& side) const;

 private:
  Vec3 flat(const Vec3& x) const { return x - x.dot(pair_.normal) * pair_.normal; }

  const ContactPair& pair_;
  const TimeScheme& scheme_;
  Vec3 common_;
  FrictionAnswer friction_;
  bool holds_, bounces_;
  double settling_;  // τ
};

}  // namespace liana
