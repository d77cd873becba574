#include "runtime/sim/contact/contacts.h"

#include <algorithm>
#include <cmath>

#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

constexpr double kImpact = 1e-3;      // m a step, beyond which an approach is an impact
constexpr double kImpactSpeed = 0.1;  // m/s, beyond which elasticity shows

}  // namespace

// A plant's base stands in the ground or in a wall and thickens there: its roots, and what is inside when it
// is made and connected to them through particles that were inside too, are left alone.
void Contacts::notice_new_particles(const Plant& plant, const CollisionScene& scene) {
  if (exempt_.size() > plant.particles.size()) exempt_.resize(plant.particles.size());
  const size_t known = exempt_.size();
  if (known == plant.particles.size()) return;
  std::vector<uint8_t> inside(plant.particles.size() - known, 0);
  for (const Gap& found : probes_.look(plant, scene, 0, known))
    if (found.gap < -1e-3) inside[found.particle - known] = 1;
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

// With the force k(t - x₁) - d v₁ of the end of the step, d = kΔt and k ≫ m/Δt², the step ends with
// (x₁ - t) + Δt v₁ = 0: the point comes to the surface and stays there. The time step takes spring forces at
// n+1-α_f, so target and its velocity are mixed with the present ones by α_f, which leaves (1-α_f) times that
// force. Velocities are those relative to the surface; to_surface (m) is the gap to where it is at the end.
//
// An elastic impact ends with a velocity instead. The acceleration a₁ that gives it lingers: a force F makes
// (1-α_m) a₁ = F/m now, and γΔt a₁ of the FΔt/m that the velocity gains in the end.
WorldSpring Contacts::spring(const Plant& plant, const Motion& motion, const Gap& found, double to_surface,
                             Grip& grip) const {
  const double dt = plant.scheme.dt, mass = plant.particles[found.particle].mass;
  const GeneralizedAlpha method(plant.scheme.rho_infinity);
  const double at_end = 1 - method.alpha_f;
  const Vec3& n = found.normal;
  const ContactFeel& feel = found.solid ? found.solid->feel : options_.ground;
  const Vec3 arm = motion.orientation * found.point, x = motion.position + arm;
  const Vec3 surface = found.solid ? found.solid->velocity_at(x) : Vec3::Zero();
  const Vec3 own = motion.velocity + motion.angular_velocity.cross(arm);
  const Vec3 velocity = own - surface;
  const double approach = velocity.dot(n);
  const double hold_stiffness = options_.stiffness_ratio * mass / (dt * dt);  // N/m, across
  const bool blade = plant.branches[plant.particles[found.particle].branch.index()].kind == DomainKind::Leaf;
  const double stiff = std::max(hold_stiffness, options_.least_stiffness);
  const double gentle = bearable_force(plant.particles[found.particle]) / std::max(1e-9, -found.gap);
  const double k = blade ? std::clamp(gentle, hold_stiffness / 16, hold_stiffness)
                         : std::clamp(gentle, hold_stiffness / 4, stiff);
  const double coming = std::max(0.0, -approach) * dt / kImpact;
  const double settling = dt * std::clamp(1.25 - coming / 4, 0.25, 1.0);  // τ
  const Mat3 normal = n * n.transpose(), across = Mat3::Identity() - normal;

  // What it holds on to now, as the surface was before it moved.
  if (!grip.holds) {
    grip.on_a = found.point;
    grip.on_b = found.solid ? found.solid->to_mesh(x + dt * surface) : x;
  }
  const Vec3 hold = (found.solid ? found.solid->to_world(grip.on_b) : grip.on_b) - dt * surface;
  const Vec3 slip = across * (motion.position + motion.orientation * grip.on_a - hold);
  const double pressing =
      std::max(at_end * k * std::max(0.0, -found.gap),
               mass * std::max(0.0, -approach - std::max(0.0, found.gap) / dt) / dt);  // N
  const FrictionAnswer friction =
      friction_answer(grip, slip, across * velocity, across * motion.acceleration, at_end * hold_stiffness,
                      found.slides ? 0 : feel.friction * pressing, mass, dt);

  // To the surface, along n.
  const double way = std::min(-to_surface, options_.push_out_speed * dt + dt * std::max(0.0, surface.dot(n)));
  WorldSpring spring;
  spring.particle = ParticleId(found.particle);
  spring.on_particle = found.point;
  spring.target = x + at_end * (way * n + friction.stretch);
  spring.stiffness = k * normal;
  spring.damping = k * settling * normal;
  spring.target_velocity = (method.alpha_f * own + at_end * surface).dot(n) * n;
  if (feel.elasticity > 0 && approach < -kImpactSpeed) {
    const double gain = method.gamma / (1 - method.alpha_m) * (1 + feel.elasticity);
    spring.stiffness.setZero();
    spring.damping = k * dt * normal;
    spring.target_velocity = (own.dot(n) - at_end * gain * approach) * n;
  }
  if (found.slides) {
    grip.holds = false;
  } else if (friction.dashpot > 0) {
    spring.damping += friction.dashpot * across;
    spring.target_velocity += across * surface;
  } else if (grip.holds) {
    spring.target += at_end * dt * across * surface;
    spring.stiffness += hold_stiffness * across;
    spring.damping += hold_stiffness * dt * across;
    spring.target_velocity += across * (method.alpha_f * own + at_end * surface);
  }
  return spring;
}

ContactReport Contacts::gather(const Plant& plant, const CollisionScene& scene,
                               std::vector<WorldSpring>& springs) {
  take(plant);
  notice_new_particles(plant, scene);
  before_.swap(made_);
  made_.clear();
  const double dt = plant.scheme.dt;
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  auto last = before_.begin();
  for (Gap found : probes_.look(plant, scene, dt, 0, clearances())) {
    if (exempt_[found.particle]) continue;
    report.max_penetration = std::max(report.max_penetration, -found.gap);
    while (last != before_.end() && last->key < found.key) ++last;
    const bool touched = last != before_.end() && last->key == found.key;
    // Across a bar that pierces it a blade has two ways out: it keeps to one.
    if (touched && found.crossed && found.normal.dot(last->normal) < 0) found.normal = -found.normal;
    const Motion& motion = plant.motion[found.particle];
    const Vec3 arm = motion.orientation * found.point;
    const Vec3 surface = found.solid ? found.solid->velocity_at(motion.position + arm) : Vec3::Zero();
    const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(arm) - surface;
    const double coming =
        dt * velocity.dot(found.normal) + dt * dt / 2 * motion.acceleration.dot(found.normal);
    // A contact that settles ends a step about τ|v| above the surface, on its way down: let go then, it would
    // fall and come again for ever.
    if (found.gap + (touched ? 3 : 1) * std::min(0.0, coming) >= 0) continue;
    // What has bounced leaves by itself.
    const double elasticity = (found.solid ? found.solid->feel : options_.ground).elasticity;
    if (elasticity > 0 && velocity.dot(found.normal) > kImpactSpeed) continue;
    Made made{found.key, found.normal, touched ? last->grip : Grip()};
    springs.push_back(spring(plant, motion, found, found.gap - dt * surface.dot(found.normal), made.grip));
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
  const double dt = after.scheme.dt;
  for (Gap found : probes_.look(after, scene, 0, 0, clearances())) {
    if (exempt_[found.particle] || found.gap > -tolerance) continue;
    if (std::binary_search(made_.begin(), made_.begin() + known, Made{found.key})) continue;
    // The plane it is behind now, seen from where it started.
    const Motion &now = after.motion[found.particle], &start = before[found.particle];
    const Vec3 from = start.position + start.orientation * found.point;
    const Vec3 came = now.position + now.orientation * found.point - from;
    const double to_surface = found.gap - came.dot(found.normal);
    const Vec3 surface = found.solid ? found.solid->velocity_at(from) : Vec3::Zero();
    found.gap = to_surface + dt * surface.dot(found.normal);
    Made made{found.key, found.normal};
    springs.push_back(spring(after, start, found, to_surface, made.grip));
    made_.push_back(made);
  }
  std::inplace_merge(made_.begin(), made_.begin() + known, made_.end());
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
