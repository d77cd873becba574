#include "runtime/sim/collision/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/sim/generalized_alpha.h"

namespace liana {
namespace {

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
// A blade is widest in the middle and ends in a point; a stem is a cylinder.
constexpr Probe kStemProbes[] = {{0, 1}, {1, 1}};
constexpr Probe kBladeProbes[] = {{0, 1}, {1, 0}};

/// Calls visit(particle index, point in the particle's frame, gap, normal) for every probe within its reach.
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
    for (const Probe& probe : blade ? kBladeProbes : kStemProbes) {
      const Vec3 on_axis = Vec3(0, probe.along * particle.half_length, 0);
      const Vec3 x = motion.position + to_world * on_axis;
      const auto report = [&](const Nearest& found) {
        if (found.distance > reach) return;
        const Vec3 arm = reach_towards(particle, to_world.transpose() * found.normal, probe.width);
        visit(i, Vec3(on_axis + arm), found.distance + (to_world * arm).dot(found.normal), found.normal);
      };
      for (const SdfObstacle* solid : scene.solids) report(nearest(*solid, x, reach));
      if (scene.ground_height) report({x.y() - *scene.ground_height, Vec3::UnitY()});
    }
  }
}

}  // namespace

// A plant's base stands in the ground or in a wall: what is inside when it is made, and connected to the root
// through particles that were inside too, is left alone.
void Contacts::notice_new_particles(const Plant& plant, const CollisionScene& scene) {
  const size_t known = exempt_.size();
  if (known == plant.particles.size()) return;
  std::vector<uint8_t> inside(plant.particles.size() - known, 0);
  for_each_gap(plant, scene, 0, known, [&](size_t i, const Vec3&, double gap, const Vec3&) {
    if (gap < -1e-3) inside[i - known] = 1;
  });
  for (size_t i = known; i < plant.particles.size(); ++i) {
    const ParticleId parent = plant.particles[i].parent;
    exempt_.push_back(!parent.valid() || (inside[i - known] && exempt_[parent.index()]));
  }
}

// With the force k(t - x₁) - d v₁ of the end of the step, d = kΔt and k ≫ m/Δt², the step ends with
// (x₁ - t) + Δt v₁ = 0: the point comes to the surface and stays there. The time step takes spring forces at
// n+1-α_f, so target and its velocity are mixed with the present ones by α_f, which leaves (1-α_f) times that
// force.
ContactReport Contacts::gather(const Plant& plant, const CollisionScene& scene,
                               std::vector<WorldSpring>& springs) {
  notice_new_particles(plant, scene);
  const double dt = plant.scheme.dt, alpha_f = GeneralizedAlpha(plant.scheme.rho_infinity).alpha_f;
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  for_each_gap(plant, scene, dt, 0, [&](size_t i, const Vec3& point, double gap, const Vec3& n) {
    if (exempt_[i]) return;
    report.max_penetration = std::max(report.max_penetration, -gap);
    const Motion& motion = plant.motion[i];
    const Vec3 arm = motion.orientation * point;
    const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(arm);
    const double approach = velocity.dot(n);
    const double coming = dt * approach + dt * dt / 2 * motion.acceleration.dot(n);
    if (gap + std::min(0.0, coming) >= 0) return;

    const double k =
        std::max(options_.stiffness_ratio * plant.particles[i].mass / (dt * dt), options_.least_stiffness);
    const double pressing = (1 - alpha_f) * k * std::max(0.0, -gap);  // N
    const Vec3 sliding = velocity - approach * n;
    const double friction = options_.friction * pressing / std::max(sliding.norm(), options_.creep_speed);
    const Mat3 normal = n * n.transpose();
    const double way = std::min(-gap, options_.push_out_speed * dt);  // to the surface, along n

    WorldSpring spring;
    spring.particle = ParticleId(i);
    spring.on_particle = point;
    spring.target = motion.position + arm + (1 - alpha_f) * way * n;
    spring.target_velocity = alpha_f * approach * n;
    spring.stiffness = k * normal;
    spring.damping = k * dt * normal + friction * (Mat3::Identity() - normal);
    springs.push_back(spring);
    ++report.contacts;
  });
  return report;
}

ContactReport Contacts::measure(const Plant& plant, const CollisionScene& scene) {
  notice_new_particles(plant, scene);
  ContactReport report;
  report.exempt = std::count(exempt_.begin(), exempt_.end(), 1);
  for_each_gap(plant, scene, 0, 0, [&](size_t i, const Vec3&, double gap, const Vec3&) {
    if (!exempt_[i]) report.max_penetration = std::max(report.max_penetration, -gap);
  });
  return report;
}

}  // namespace liana
