#include "runtime/sim/collision/probes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace liana {
namespace {

constexpr size_t kAtOnce = 32;    // neighbours in the arrays are neighbours in space
constexpr double kSlow = 5e-3;    // m a step, below which the solid is a half space
constexpr uint64_t kBetween = 3;  // the probe between the ends
constexpr double kTouch = 2e-4;   // m, at which a sweep has arrived

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

double exact_distance(const SdfObstacle& solid, const Vec3& x) {
  const double d = solid.distance(x);
  return std::abs(d) < solid.band() ? d : solid.closest_point(x).distance;
}

/// The point of an elliptical cross-section furthest along -normal, in the particle's frame, from its axis.
Vec3 reach_towards(const Particle& particle, const Vec3& local_normal, double scale) {
  const double a = particle.half_width * scale, b = particle.half_thickness * scale;
  const Vec3 squared(a * a * local_normal.x(), 0, b * b * local_normal.z());
  const double reach = std::sqrt(squared.x() * local_normal.x() + squared.z() * local_normal.z());
  return reach > 0 ? Vec3(-squared / reach) : Vec3::Zero();
}

double travel_of(const Particle& particle, const Motion& motion, double dt) {
  return dt * (motion.velocity.norm() + particle.half_length * motion.angular_velocity.norm() +
               dt * motion.acceleration.norm() / 2);
}

/// Where on its axis, in [-1, 1], a particle is nearest to a solid, when that is neither an end nor the
/// middle. The distance to a convex solid along a line is convex.
std::optional<double> thin_between(const Particle& particle, const Motion& motion, const SdfObstacle& solid,
                                   const Vec3& shift, double reach) {
  const Vec3 axis = motion.orientation * Vec3(0, particle.half_length, 0), centre = motion.position + shift;
  const double middle = solid.distance(centre);
  if (middle > particle.half_length + reach) return {};
  const auto distance = [&](double s) { return exact_distance(solid, centre + s * axis); };
  const double tail = distance(-1), mid = distance(0), head = distance(1);
  if (std::abs(head + tail - 2 * mid) < kTouch) return {};  // flat
  double low = head < tail ? 0 : -1, high = low + 1;
  if (mid < head && mid < tail) low = -1, high = 1;
  constexpr double kGolden = 0.61803398874989485;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low), da = distance(a),
         db = distance(b);
  for (int i = 0; i < 9; ++i) {
    if (da < db) {
      high = b, b = a, db = da, a = high - kGolden * (high - low), da = distance(a);
    } else {
      low = a, a = b, da = db, b = low + kGolden * (high - low), db = distance(b);
    }
  }
  const double best = std::min(da, db);
  if (best > reach || best > std::min({tail, mid, head}) - kTouch) return {};
  return da < db ? a : b;
}

}  // namespace

const std::vector<Gap>& Probes::look(const Plant& plant, const CollisionScene& scene, double dt,
                                     size_t first) {
  gaps_.clear();
  for (size_t i = first; i < plant.particles.size(); i += kAtOnce)
    look(plant, scene, dt, i, std::min(i + kAtOnce, plant.particles.size()));
  return gaps_;
}

void Probes::look(const Plant& plant, const CollisionScene& scene, double dt, size_t first, size_t last) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (size_t i = first; i < last; ++i) {
    const Particle& particle = plant.particles[i];
    const double around = particle.half_length + std::max(particle.half_width, particle.half_thickness) +
                          travel_of(particle, plant.motion[i], dt);
    low = low.cwiseMin((plant.motion[i].position.array() - around).matrix());
    high = high.cwiseMax((plant.motion[i].position.array() + around).matrix());
  }
  near_.clear();
  for (uint32_t s = 0; s < scene.solids.size(); ++s) {
    const SdfObstacle& solid = *scene.solids[s];
    // It comes from where it was at the start of the step.
    const Vec3 half = (solid.high() - solid.low()) / 2;
    const double way = dt * (solid.pose().velocity.norm() +
                             solid.pose().angular_velocity.norm() *
                                 (half.norm() + (solid.low() + half - solid.pose().centre).norm()));
    if ((solid.low().array() - way <= high.array()).all() &&
        (low.array() <= solid.high().array() + way).all())
      near_.push_back(s);
  }
  const double ground = scene.ground_height.value_or(-std::numeric_limits<double>::infinity());
  const bool near_ground = low.y() <= ground;
  if (near_.empty() && !near_ground) return;

  for (size_t i = first; i < last; ++i) {
    const Particle& particle = plant.particles[i];
    const uint64_t probes = particle.joint.shear_stiffness.isZero(0) ? 3 : 2;
    constexpr double kAlong[] = {0, 1, -1};
    for (uint64_t p = 0; p < probes; ++p) {
      if (near_ground) at(plant, i, p, kAlong[p], dt, nullptr, 0, ground);
      for (const uint32_t s : near_) at(plant, i, p, kAlong[p], dt, scene.solids[s], s + 1, ground);
    }
    const double reach =
        std::max(particle.half_width, particle.half_thickness) + travel_of(particle, plant.motion[i], dt);
    for (const uint32_t s : near_) {
      const SdfObstacle& solid = *scene.solids[s];
      const Vec3 shift = dt * solid.velocity_at(plant.motion[i].position);
      if (const auto between = thin_between(particle, plant.motion[i], solid, shift, reach + shift.norm()))
        at(plant, i, kBetween, *between, dt, &solid, s + 1, ground);
    }
  }
}

void Probes::at(const Plant& plant, size_t i, uint64_t probe, double along, double dt,
                const SdfObstacle* solid, uint64_t number, double ground) {
  const Particle& particle = plant.particles[i];
  const Motion& motion = plant.motion[i];
  const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
  // A blade is widest in the middle and ends in a point; a stem is a cylinder.
  // Between its middle and its ends its axis counts alone: its rims would take turns.
  const double width = blade && probe != 0 ? 0 : 1;
  const Vec3 on_axis(0, along * particle.half_length, 0);
  const Vec3 arm_to_axis = motion.orientation * on_axis;
  // Seen from the solid, which stands where it will be, the point starts as far ahead as the solid moves.
  const Vec3 solid_velocity = solid ? solid->velocity_at(motion.position + arm_to_axis) : Vec3::Zero();
  const Vec3 start = motion.position + arm_to_axis + dt * solid_velocity;
  const Vec3 way = dt * (motion.velocity + motion.angular_velocity.cross(arm_to_axis) - solid_velocity +
                         dt / 2 * motion.acceleration);
  const double radius = std::max(particle.half_width, particle.half_thickness) * width;
  const double reach = radius + way.norm();
  const auto nearest_to = [&](const Vec3& x) {
    return solid ? nearest(*solid, x, reach) : Nearest{x.y() - ground, Vec3::UnitY()};
  };
  Vec3 x = start;
  Nearest on_axis_found = nearest_to(x);
  if (on_axis_found.distance > reach) return;
  // Fast ones are followed to where they arrive: a bar that they pass by is no wall.
  const double length = way.norm();
  if (solid && length > kSlow && on_axis_found.distance > radius) {
    double gone = 0;
    for (int i = 0; i < 64; ++i) {
      const double free = on_axis_found.distance - radius;
      if (free < kTouch) break;
      gone += free;
      if (gone > length) return;
      x = start + gone / length * way;
      on_axis_found = nearest_to(x);
      if (!std::isfinite(on_axis_found.distance)) return;
    }
  }
  const Vec3 arm = reach_towards(particle, motion.orientation.conjugate() * on_axis_found.normal, width);
  // Beside an edge the solid is no half space: what counts is the distance of the point itself.
  const Nearest found = nearest_to(x + motion.orientation * arm);
  if (found.distance > reach) return;
  const double gap = found.distance + (start - x).dot(found.normal);
  Vec3 normal = found.normal;
  if (probe == kBetween && gap < 0) {
    // What an edge crosses goes out across itself: along the normals of the two faces that meet there it
    // would go to and fro, or be pushed along itself.
    const Vec3 axis = motion.orientation * Vec3::UnitY(), plane = motion.orientation * Vec3::UnitZ();
    const Vec3 across = blade ? Vec3(normal.dot(plane) * plane) : Vec3(normal - normal.dot(axis) * axis);
    if (across.norm() > 0.1) normal = across.normalized();
  }
  // A round stem is held at its axis: held at its skin, a point that turns with it, it would be rolled over
  // by its own weight.
  gaps_.push_back({i, (uint64_t(i) * 4 + probe) << 16 | number, solid, blade ? Vec3(on_axis + arm) : on_axis,
                   gap, normal});
}

}  // namespace liana
