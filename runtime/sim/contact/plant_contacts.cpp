#include "runtime/sim/contact/plant_contacts.h"

#include <algorithm>
#include <utility>

#include "mesher/base/error.h"
#include "runtime/sim/contact/make_room.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

/// kg: what a free particle opposes to a push along n (unit) at a lever from its centre (m).
double mass_at(const Particle& particle, const Motion& motion, const Vec3& arm, const Vec3& n) {
  const Vec3 turning = motion.orientation.conjugate() * arm.cross(n);
  return 1 / (1 / particle.mass + turning.cwiseAbs2().dot(particle.inertia.cwiseMax(1e-15).cwiseInverse()));
}

}  // namespace

/// One particle of a pair.
struct PlantContacts::Body {
  Body(const BroadPhase::Body& body, std::span<const Plant* const> plants)
      : name(body.name),
        blade(body.outline.blade),
        scheme(plants[name.plant]->scheme),
        particle(plants[name.plant]->particles[name.particle]),
        motion(plants[name.plant]->motion[name.particle]) {}

  Proxy proxy() const { return {particle, motion, blade}; }
  Vec3 velocity_at(const Vec3& arm) const { return motion.velocity + motion.angular_velocity.cross(arm); }
  Vec3 to_own(const Vec3& arm) const { return motion.orientation.conjugate() * arm; }
  ContactSide side(const Vec3& arm, double share, double sign) const {
    return {ParticleId(name.particle), to_own(arm), motion.position + arm, velocity_at(arm), share, sign};
  }

  ParticleName name;
  bool blade;
  const TimeScheme& scheme;
  const Particle& particle;
  const Motion& motion;
};

void PlantContacts::take(size_t plant, const Plant& of) {
  if (slots_.size() <= plant) slots_.resize(plant + 1);
  slots_[plant].take(of.removals, [&](const Remap& remap) {
    follow(cache_, static_cast<uint32_t>(plant), remap);
    broad_phase_.forget_all();
  });
}

void PlantContacts::forget(uint32_t plant) {
  if (plant < slots_.size()) slots_.erase(slots_.begin() + plant);
  liana::forget(cache_, plant);
  broad_phase_.forget_all();
}

PlantContactReport PlantContacts::gather(std::span<const Plant* const> plants,
                                         std::span<std::vector<WorldSpring>* const> springs) {
  require(springs.size() == plants.size(), "every plant has a list of springs");
  for (size_t k = 0; k < plants.size(); ++k) take(k, *plants[k]);
  broad_phase_.update(plants, cache_);
  PlantContactReport report;
  report.listed = broad_phase_.listed();
  next_cache_.clear();
  make_room(next_cache_, broad_phase_.bodies());
  for (BroadPhase::Pair& pair : broad_phase_.pairs())
    if (pair.cached != BroadPhase::kNone || broad_phase_.may_touch(pair, static_cast<float>(options_.apart)))
      touch(pair, plants, springs, report);
  cache_.swap(next_cache_);
  report.candidates = broad_phase_.pairs().size();
  broad_phase_.end(plants);
  return report;
}

void PlantContacts::keep(BroadPhase::Pair& pair, const CachedContact& contact) {
  pair.cached = static_cast<uint32_t>(next_cache_.size());
  next_cache_.push_back(contact);
}

void PlantContacts::touch(BroadPhase::Pair& candidate, std::span<const Plant* const> plants,
                          std::span<std::vector<WorldSpring>* const> springs, PlantContactReport& report) {
  const BroadPhase::Body &body_a = broad_phase_.body(candidate.a), &body_b = broad_phase_.body(candidate.b);
  const Body a(body_a, plants), b(body_b, plants);
  const double dt = a.scheme.dt;
  const uint32_t old = std::exchange(candidate.cached, BroadPhase::kNone);
  const bool known = old != BroadPhase::kNone;
  CachedContact contact = known ? cache_[old] : CachedContact{{a.name, b.name}};
  const Vec3* side = known && !contact.exempt ? &contact.normal : nullptr;

  const Vec3 acceleration = a.motion.acceleration - b.motion.acceleration;
  const double far = options_.apart + dt * (b.motion.velocity - a.motion.velocity).norm() +
                     dt * (turning_speed(a.particle, a.motion) + turning_speed(b.particle, b.motion) +
                           dt / 2 * acceleration.norm());
  const ContactGeometry met = narrow_phase(a.proxy(), b.proxy(), side, far);
  if (met.gap > far) return;
  if (!known && met.gap < 0 && (broad_phase_.is_new(body_a) || broad_phase_.is_new(body_b)))
    contact.exempt = true;
  if (contact.exempt && met.gap < options_.apart) {
    ++report.exempt;
    return keep(candidate, contact);
  }
  contact.exempt = false;

  const Vec3 velocity_a = a.velocity_at(met.arm_a), velocity_b = b.velocity_at(met.arm_b);
  ContactPair pair{.normal = met.normal,
                   .gap = met.gap,
                   .velocity = velocity_a - velocity_b,
                   .acceleration = acceleration,
                   .material = options_.material};
  if (!touches(pair, side != nullptr, dt, options_.weights)) return;
  ++report.contacts;
  report.max_overlap = std::max(report.max_overlap, -met.gap);
  contact.normal = met.normal;
  const Masses masses = masses_of(a, b, met);
  stiffen(a, b, met, masses, pair);

  StickAnchor& anchor = contact.anchor;
  if (!anchor.holds) anchor.on_a = a.to_own(met.arm_a), anchor.on_b = b.to_own(met.arm_b);
  const Vec3 slip = a.motion.position + a.motion.orientation * anchor.on_a - b.motion.position -
                    b.motion.orientation * anchor.on_b;
  const double share_a = masses.share_a, share_b = 1 - share_a;
  const Vec3 common = share_a * velocity_b + share_b * velocity_a;
  const ContactResponse response(pair, anchor, slip, common, a.scheme, options_.weights);
  springs[a.name.plant]->push_back(response.spring(a.side(met.arm_a, share_a, 1)));
  springs[b.name.plant]->push_back(response.spring(b.side(met.arm_b, share_b, -1)));
  keep(candidate, contact);
}

// How much of the way each one goes: k / share has the same frequency for both.
PlantContacts::Masses PlantContacts::masses_of(const Body& a, const Body& b,
                                               const ContactGeometry& met) const {
  const double of_a = mass_at(a.particle, a.motion, met.arm_a, met.normal);
  const double of_b = mass_at(b.particle, b.motion, met.arm_b, met.normal);
  constexpr double kLeastMass = 1e-12, kLeastShare = 1e-3;  // kg; keep the quotients finite
  const double sum = std::max(of_a + of_b, kLeastMass);
  const double share_a = std::clamp(of_b / sum, kLeastShare, 1 - kLeastShare);
  return {sum * share_a * (1 - share_a), share_a};
}

// Springs to the world resist the acceleration of what moves together like a mass of kΔt²: soft where a touch
// is light, hard where it would be deep. The force k₀δ (1 + d²), d the depth by met.soft, with its own slope.
void PlantContacts::stiffen(const Body& a, const Body& b, const ContactGeometry& met, const Masses& masses,
                            ContactPair& pair) const {
  const double dt = a.scheme.dt, at_end = 1 - GeneralizedAlpha(a.scheme.rho_infinity).alpha_f;
  const double depth = std::clamp(-(met.gap + pair.coming(dt)) / met.soft, 0.0, options_.deepest);
  const double light = options_.stiffness_ratio * masses.reduced / (dt * dt);
  const double bearable =
      std::min(bearable_force(a.particle), bearable_force(b.particle)) / std::max(1e-9, -met.gap);
  const double secant_limit = light * (1 + depth * depth);
  pair.mass = masses.reduced;
  pair.stiffness = pair.stick =
      std::clamp(bearable, options_.softest * light, light * (1 + 3 * depth * depth));
  const double secant = std::min(pair.stiffness, secant_limit);
  pair.load = at_end * secant * std::max(0.0, -met.gap);
  const double out = a.blade || b.blade ? options_.blades_apart_speed : options_.push_out_speed;
  const double way = std::min(-met.gap, out * dt);
  pair.way = way > 0 ? secant / pair.stiffness * way : way;
}

}  // namespace liana
