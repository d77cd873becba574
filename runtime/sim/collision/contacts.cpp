#include "runtime/sim/collision/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/sim/generalized_alpha.h"

namespace liana {
namespace {

constexpr double kImpact = 1e-3;  // m a step, beyond which an approach is an impact

/// A plane that touches a solid where it is closest to a point.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  // m, of the point
  Vec3 normal = Vec3::UnitY();
};

Nearest nearest(const SdfObstacle& solid, const Vec3& x, double reach) {
  const SdfSample field = solid.sample(x);
  if (field.distance > reach) return {};
  if (std::abs(field.distance) < solid.band()) return {field.distance, field.gradient};
  const SurfacePoint exact = solid.closest_point(x);
  if (exact.distance > reach) return {};
  const Vec3 away = x - exact.point;
  return {exact.distance, std::abs(exact.distance) > 1e-9 ? Vec3(away / exact.distance) : exact.normal};
}

/// The point of an elliptical cross-section furthest along -normal, in the particle's frame, from its axis.
Vec3 reach_towards(const Particle& particle, const Vec3& local_normal, double scale) {
  const double a = particle.half_width * scale, b = particle.half_thickness * scale;
  const Vec3 squared(a * a * local_normal.x(), 0, b * b * local_normal.z());
  const double reach = std::sqrt(squared.x() * local_normal.x() + squared.z() * local_normal.z());
  return reach > 0 ? Vec3(-squared / reach) : Vec3::Zero();
}

/// One point of a particle's axis that is tested: how far along it, and the width of the cross-section there.
struct Probe {
  double along, width;
};
// A blade is widest in the middle and ends in a point; a stem is a cylinder. The tail is tested of loose ones
// only.
constexpr Probe kStemProbes[] = {{0, 1}, {1, 1}, {-1, 1}};
constexpr Probe kBladeProbes[] = {{0, 1}, {1, 0}, {-1, 0}};

/// What a probe of a particle finds at one solid: where it touches first, and how far that is.
struct Gap {
  size_t particle;
  uint64_t key;  // ascending in the order of visits
  Vec3 point;    // m, particle's frame: what a spring holds
  double gap;    // m, negative inside
  Vec3 normal;   // unit, away from the solid
};

/// Calls visit(Gap) for every probe of particles from `first` on that can get into something within dt.
template <class Visit>
void for_each_gap(const Plant& plant, const CollisionScene& scene, double dt, size_t first,
                  const Visit& visit) {
  for (size_t i = first; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Motion& motion = plant.motion[i];
    const Mat3 to_world = motion.orientation.toRotationMatrix();
    const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
    const double travel =
        dt * (motion.velocity.norm() + particle.half_length * motion.angular_velocity.norm() +
              dt * motion.acceleration.norm() / 2);
    const double reach = std::max(particle.half_width, particle.half_thickness) + travel;
    const uint64_t probes = particle.joint.shear_stiffness.isZero(0) ? 3 : 2;
    for (uint64_t p = 0; p < probes; ++p) {
      const Probe& probe = (blade ? kBladeProbes : kStemProbes)[p];
      const Vec3 on_axis = Vec3(0, probe.along * particle.half_length, 0);
      const Vec3 x = motion.position + to_world * on_axis;
      const auto look = [&](uint64_t solid, const auto& nearest_to) {
        const Nearest on_axis_found = nearest_to(x);
        if (on_axis_found.distance > reach) return;
        const Vec3 arm = reach_towards(particle, to_world.transpose() * on_axis_found.normal, probe.width);
        // Beside an edge the solid is no half space: what counts is the distance of the point itself.
        const Nearest found = nearest_to(x + to_world * arm);
        // A round stem is held at its axis: held at its skin, a point that turns with it, it would be rolled
        // over by its own weight.
        if (found.distance <= reach)
          visit(Gap{i, (uint64_t(i) * 4 + p) << 16 | solid, blade ? Vec3(on_axis + arm) : on_axis,
                    found.distance, found.normal});
      };
      for (size_t s = 0; s < scene.solids.size(); ++s)
        look(s + 1, [&](const Vec3& at) { return nearest(*scene.solids[s], at, reach); });
      if (scene.ground_height)
        look(0, [&](const Vec3& at) { return Nearest{at.y() - *scene.ground_height, Vec3::UnitY()}; });
    }
  }
}

}  // namespace

// A plant's base stands in the ground or in a wall and thickens there: its roots, and what is inside when it
// is made and connected to them through particles that were inside too, are left alone.
void Contacts::notice_new_particles(const Plant& plant, const CollisionScene& scene) {
  const size_t known = exempt_.size();
  if (known == plant.particles.size()) return;
  std::vector<uint8_t> inside(plant.particles.size() - known, 0);
  for_each_gap(plant, scene, 0, known, [&](const Gap& found) {
    if (found.gap < -1e-3) inside[found.particle - known] = 1;
  });
  for (size_t i = known; i < plant.particles.size(); ++i) {
    const ParticleId parent = plant.particles[i].parent;
    const bool held = !plant.particles[i].joint.shear_stiffness.isZero(0);
    exempt_.push_back(parent.valid() ? inside[i - known] && exempt_[parent.index()] : held);
  }
}

void Contacts::follow(const TopologyChange& change) {
  size_t kept = 0;
  for (size_t i = 0; i < exempt_.size() && i < change.particles.size(); ++i)
    if (change.particles[i].valid()) exempt_[kept++] = exempt_[i];
  exempt_.resize(kept);
}

// With the force k(t - x₁) - d v₁ of the end of the step, d = kΔt and k ≫ m/Δt², the step ends with
// (x₁ - t) + Δt v₁ = 0: the point comes to the surface and stays there. The time step takes spring forces at
// n+1-α_f, so target and its velocity are mixed with the present ones by α_f, which leaves (1-α_f) times that
// force.
WorldSpring Contacts::spring(const Plant& plant, const Motion& motion, size_t particle, const Vec3& point,
                             double gap, const Vec3& n) const {
  const double dt = plant.scheme.dt, alpha_f = GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f;
  const Vec3 arm = motion.orientation * point;
  const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(arm);
  const double approach = velocity.dot(n);
  const double k = std::max(options_.stiffness_ratio * plant.particles[particle].mass / (dt * dt),
                            options_.least_stiffness);
  const double coming = std::max(0.0, -approach) * dt / kImpact;
  const double settling = dt * std::clamp(1.25 - coming / 4, 0.25, 1.0);  // τ
  const double pressing = (1 - alpha_f) * k * std::max(0.0, -gap);        // N
  const Vec3 sliding = velocity - approach * n;
  const double friction = options_.friction * pressing / std::max(sliding.norm(), options_.creep_speed);
  const Mat3 normal = n * n.transpose();
  const double way = std::min(-gap, options_.push_out_speed * dt);  // to the surface, along n

  WorldSpring spring;
  spring.particle = ParticleId(particle);
  spring.on_particle = point;
  spring.target = motion.position + arm + (1 - alpha_f) * way * n;
  spring.target_velocity = alpha_f * approach * n;
  spring.stiffness = k * normal;
  spring.damping = k * settling * normal + friction * (Mat3::Identity() - normal);
  return spring;
}

ContactReport Contacts::gather(const Plant& plant, const CollisionScene& scene,
                               std::vector<WorldSpring>& springs) {
  notice_new_particles(plant, scene);
  made_.clear();
  const double dt = plant.scheme.dt;
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  for_each_gap(plant, scene, dt, 0, [&](const Gap& found) {
    if (exempt_[found.particle]) return;
    report.max_penetration = std::max(report.max_penetration, -found.gap);
    const Motion& motion = plant.motion[found.particle];
    const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(motion.orientation * found.point);
    const double coming =
        dt * velocity.dot(found.normal) + dt * dt / 2 * motion.acceleration.dot(found.normal);
    if (found.gap + std::min(0.0, coming) >= 0) return;
    springs.push_back(spring(plant, motion, found.particle, found.point, found.gap, found.normal));
    made_.push_back(found.key);
    ++report.contacts;
  });
  return report;
}

size_t Contacts::gather_missed(const Plant& after, std::span<const Motion> before,
                               const CollisionScene& scene, double tolerance,
                               std::vector<WorldSpring>& springs) {
  const size_t known = made_.size();
  for_each_gap(after, scene, 0, 0, [&](const Gap& found) {
    if (exempt_[found.particle] || found.gap > -tolerance) return;
    if (std::binary_search(made_.begin(), made_.begin() + known, found.key)) return;
    // The plane it is behind now, seen from where it started.
    const Motion &now = after.motion[found.particle], &start = before[found.particle];
    const Vec3 came =
        now.position + now.orientation * found.point - start.position - start.orientation * found.point;
    const double gap = found.gap - came.dot(found.normal);
    springs.push_back(spring(after, start, found.particle, found.point, gap, found.normal));
    made_.push_back(found.key);
  });
  std::inplace_merge(made_.begin(), made_.begin() + known, made_.end());
  return made_.size() - known;
}

ContactReport Contacts::measure(const Plant& plant, const CollisionScene& scene) {
  notice_new_particles(plant, scene);
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  for_each_gap(plant, scene, 0, 0, [&](const Gap& found) {
    if (!exempt_[found.particle]) report.max_penetration = std::max(report.max_penetration, -found.gap);
  });
  return report;
}

}  // namespace liana
