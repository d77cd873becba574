#include "runtime/sim/contact/contacts.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/contact/make_room.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"

namespace liana {

/// A particle's point and the surface that it meets.
struct Contacts::Touch {
  ContactPair pair;
  ContactSide side;
  Vec3 surface;  // m/s, how that moves there
};

// A plant's base stands in the ground or in a wall and thickens there: its roots, and what is inside when it
// is made and connected to them through particles that were inside too, are left alone.
void Contacts::notice_new_particles(const Plant& plant, const CollisionScene& scene) {
  if (exempt_.size() > plant.particles.size()) exempt_.resize(plant.particles.size());
  const size_t known = exempt_.size();
  if (known == plant.particles.size()) return;
  std::vector<uint8_t> inside(plant.particles.size() - known, 0);
  for (const Gap& found : probes_.look(plant, scene, 0, known))
    if (found.gap < -options_.buried) inside[found.particle - known] = 1;
  for (size_t i = known; i < plant.particles.size(); ++i) {
    const ParticleId parent = plant.particles[i].parent;
    const bool held = !plant.particles[i].joint.shear_stiffness.isZero(0);
    exempt_.push_back(parent.valid() ? inside[i - known] && exempt_[parent.index()] : held);
  }
}

void Contacts::take(const Plant& plant) {
  slots_.take(plant.removals, [&](const Remap& remap) {
    remap.keep_particles(exempt_);
    clearances_.follow(remap);
    made_.clear();
  });
}

Contacts::Touch Contacts::touch_of(const Plant& plant, const Motion& motion, const Gap& found) const {
  const Vec3 arm = motion.orientation * found.point, x = motion.position + arm;
  const Vec3 own = motion.velocity + motion.angular_velocity.cross(arm);
  const Vec3 surface = found.solid ? found.solid->velocity_at(x) : Vec3::Zero();
  return {.pair = {.normal = found.normal,
                   .gap = found.gap,
                   .velocity = own - surface,
                   .acceleration = motion.acceleration,
                   .mass = plant.particles[found.particle].mass,
                   .slides = found.slides,
                   .material = found.solid ? found.solid->material : options_.ground},
          .side = {ParticleId(found.particle), found.point, x, own},
          .surface = surface};
}

// An obstacle gives no way: k ≫ m/Δt², but no more than the particle's joint bears.
void Contacts::stiffen(const Plant& plant, const Gap& found, ContactPair& pair) const {
  const Particle& particle = plant.particles[found.particle];
  const double dt = plant.scheme.dt, at_end = 1 - GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f;
  const double depth = std::max(0.0, -pair.gap);
  pair.stick = options_.stiffness_ratio * particle.mass / (dt * dt);
  const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
  const double gentle = bearable_force(particle) / std::max(1e-9, depth);
  pair.stiffness = blade ? std::clamp(gentle, options_.softest_blade * pair.stick, pair.stick)
                         : std::clamp(gentle, options_.softest_stem * pair.stick,
                                      std::max(pair.stick, options_.least_stiffness));
  pair.load = std::max(at_end * pair.stiffness * depth,
                       particle.mass * std::max(0.0, -pair.approach() - std::max(0.0, pair.gap) / dt) / dt);
  pair.way = std::min(-pair.gap, options_.push_out_speed * dt);
}

WorldSpring Contacts::respond(const Plant& plant, const Motion& motion, const Gap& found, Touch& touch,
                              StickAnchor& anchor) const {
  stiffen(plant, found, touch.pair);
  // What it holds on to now, as the surface was before it moved.
  const Vec3 moved = plant.scheme.dt * touch.surface;
  if (!anchor.holds) {
    anchor.on_a = found.point;
    anchor.on_b = found.solid ? found.solid->to_mesh(touch.side.point + moved) : touch.side.point;
  }
  const Vec3 hold = (found.solid ? found.solid->to_world(anchor.on_b) : anchor.on_b) - moved;
  const Vec3 slip = motion.position + motion.orientation * anchor.on_a - hold;
  return ContactResponse(touch.pair, anchor, slip, touch.surface, plant.scheme, options_.weights)
      .spring(touch.side);
}

ContactReport Contacts::gather(const Plant& plant, const CollisionScene& scene,
                               std::vector<WorldSpring>& springs) {
  take(plant);
  notice_new_particles(plant, scene);
  before_.swap(made_);
  made_.clear();
  make_room(made_, plant.particles.size());
  make_room(springs, plant.particles.size());
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  auto last = before_.begin();
  for (Gap found : probes_.look(plant, scene, plant.scheme.dt, 0, clearances())) {
    if (exempt_[found.particle]) continue;
    report.max_penetration = std::max(report.max_penetration, -found.gap);
    while (last != before_.end() && last->key < found.key) ++last;
    const bool lasting = last != before_.end() && last->key == found.key;
    // Across a bar that pierces it a blade has two ways out: it keeps to one.
    if (lasting && found.crossed && found.normal.dot(last->normal) < 0) found.normal = -found.normal;
    const Motion& motion = plant.motion[found.particle];
    Touch touch = touch_of(plant, motion, found);
    if (!touches(touch.pair, lasting, plant.scheme.dt, options_.weights)) continue;
    Made made{found.key, found.normal, lasting ? last->anchor : StickAnchor()};
    springs.push_back(respond(plant, motion, found, touch, made.anchor));
    made_.push_back(made);
    ++report.contacts;
  }
  return report;
}

size_t Contacts::gather_missed(const Plant& after, std::span<const Motion> before,
                               const CollisionScene& scene, double tolerance,
                               std::vector<WorldSpring>& springs) {
  slots_.check(after.removals);
  const size_t known = made_.size();
  for (Gap found : probes_.look(after, scene, 0, 0, clearances())) {
    if (exempt_[found.particle] || found.gap > -tolerance) continue;
    if (std::binary_search(made_.begin(), made_.begin() + known, Made{found.key})) continue;
    // The plane it is behind now, seen from where it started.
    const Motion &now = after.motion[found.particle], &start = before[found.particle];
    const Vec3 from = start.position + start.orientation * found.point;
    const Vec3 came = now.position + now.orientation * found.point - from;
    const Vec3 surface = found.solid ? found.solid->velocity_at(from) : Vec3::Zero();
    found.gap += after.scheme.dt * surface.dot(found.normal) - came.dot(found.normal);
    Touch touch = touch_of(after, start, found);
    Made made{found.key, found.normal};
    springs.push_back(respond(after, start, found, touch, made.anchor));
    made_.push_back(made);
  }
  std::sort(made_.begin(), made_.end());
  return made_.size() - known;
}

ContactReport Contacts::measure(const Plant& plant, const CollisionScene& scene) {
  take(plant);
  notice_new_particles(plant, scene);
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  for (const Gap& found : probes_.look(plant, scene, 0))
    if (!exempt_[found.particle]) report.max_penetration = std::max(report.max_penetration, -found.gap);
  return report;
}

}  // namespace liana
