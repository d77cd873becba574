#include "runtime/sim/contact/contact_response.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/step/generalized_alpha.h"

namespace liana {
namespace {

constexpr double kLeastSpeed = 1e-5;  // m/s: keeps a dashpot finite

}  // namespace

double ContactPair::coming(double dt) const {
  return std::min(0.0, dt * approach() + dt * dt / 2 * acceleration.dot(normal));
}

bool touches(const ContactPair& pair, bool lasting, double dt, const ContactWeights& weights) {
  if (pair.gap + (lasting ? weights.linger : 1) * pair.coming(dt) >= 0) return false;
  return pair.material.restitution == 0 || pair.approach() <= weights.bounce_speed;
}

FrictionAnswer friction_answer(StickAnchor& anchor, const Vec3& slip, const ContactPair& pair,
                               double stiffness, double dt, const ContactWeights& weights) {
  const auto flat = [&](const Vec3& x) { return Vec3(x - x.dot(pair.normal) * pair.normal); };
  const double limit = pair.slides ? 0 : pair.material.friction * pair.load;
  const Vec3 velocity = flat(pair.velocity);
  if (anchor.holds) {
    const double pull = stiffness * slip.norm();
    if (pull <= limit) return {-slip, 0};
    anchor.holds = false;
    const double speed = velocity.norm() + (pull - limit) * dt / pair.mass;
    return {Vec3::Zero(), limit / std::max(kLeastSpeed, speed)};
  }
  const double speed = velocity.norm(), next = (velocity + dt * flat(pair.acceleration)).norm();
  if (speed < weights.stick_speed && next <= speed) {
    anchor.holds = true;
    return {};
  }
  return {Vec3::Zero(), limit / std::max(kLeastSpeed, next)};
}

ContactResponse::ContactResponse(const ContactPair& pair, StickAnchor& anchor, const Vec3& slip,
                                 const Vec3& common, const TimeScheme& scheme, const ContactWeights& weights)
    : pair_(pair),
      scheme_(scheme),
      common_(common),
      bounces_(pair.material.restitution > 0 && pair.approach() < -weights.bounce_speed) {
  const double dt = scheme.dt, at_end = 1 - GeneralizedAlpha(scheme.rho_infinity).alpha_f;
  friction_ = friction_answer(anchor, flat(slip), pair, at_end * pair.stick, dt, weights);
  if (pair.slides) anchor.holds = false;
  holds_ = anchor.holds;
  settling_ = dt * std::clamp(weights.gentlest - std::max(0.0, -pair.approach()) * dt / weights.impact,
                              weights.hardest, weights.longest);
}

WorldSpring ContactResponse::spring(const ContactSide& side) const {
  const GeneralizedAlpha method(scheme_.rho_infinity);
  const double dt = scheme_.dt, at_end = 1 - method.alpha_f;
  const Vec3& n = pair_.normal;
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  const double k = pair_.stiffness / side.share, stick = pair_.stick / side.share;
  const Vec3& own = side.velocity;
  WorldSpring spring;
  spring.particle = side.particle;
  spring.on_particle = side.on_particle;
  spring.target = side.point + at_end * (side.share * side.sign * (pair_.way * n + friction_.stretch) +
                                         dt * common_.dot(n) * n);
  spring.stiffness = k * along;
  spring.damping = k * settling_ * along;
  spring.target_velocity = (method.alpha_f * own + at_end * common_).dot(n) * n;
  if (bounces_) {
    const double gain = method.gamma / (1 - method.alpha_m) * (1 + pair_.material.restitution);
    const double end = own.dot(n) + gain * (common_ - own).dot(n);
    spring.stiffness.setZero();
    spring.damping = k * dt * along;
    spring.target_velocity = (method.alpha_f * own.dot(n) + at_end * end) * n;
  }
  if (pair_.slides) return spring;
  if (friction_.dashpot > 0) {
    spring.damping += friction_.dashpot / side.share * across;
    spring.target_velocity += flat(common_);
  } else if (holds_) {
    spring.target += at_end * dt * flat(common_);
    spring.stiffness += stick * across;
    spring.damping += stick * dt * across;
    spring.target_velocity += flat(method.alpha_f * own + at_end * common_);
  }
  return spring;
}

}  // namespace liana
