#include "runtime/growth/shoot_growth.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/growth/segments.h"
#include "runtime/growth/tropisms.h"
#include "runtime/sim/model/rotation.h"

namespace liana {

Vec3 course_on_surface(const Vec3& normal, double course) {
  const Vec3 up = Vec3::UnitY() - normal.y() * normal;
  if (up.norm() < 0.3) return Vec3::Zero();
  return rotation_about(normal, course) * up.normalized();
}

Quat tip_turn(const Shoot& shoot, const Vec3& forward, double radius, const std::optional<Support>& support,
              const Surroundings& around, const TropismParameters& parameters, double wander, double dt) {
  const double noise = parameters.wander * std::sqrt(dt) * wander;
  if (!support) {
    const Quat light = phototropism(forward, around.to_sun, 1 - shoot.light, parameters.phototropism * dt);
    const Quat up = steering(forward, Vec3::UnitY(), parameters.climbing * dt);
    return rotation_about(around.to_sun.unitOrthogonal(), noise) * up * light;
  }
  const Vec3& normal = support->normal;
  const double gap = support->distance - radius - parameters.cling_gap;
  const double ease = std::clamp(gap / parameters.approach_length, -1.0, 1.0);
  const Vec3 course = course_on_surface(normal, shoot.course);
  const Vec3 square_turn = course.isZero(0) ? normal.unitOrthogonal() : Vec3(course.cross(normal));
  const Quat adapt = surface_adaption(forward, -normal, ease * fixed::sin(parameters.approach_angle),
                                      parameters.surface_adaption * dt, square_turn);
  // A tip that holds on follows the light along the surface only: it does not let go for more.
  const Vec3 light_on_surface = around.to_sun - around.to_sun.dot(normal) * normal;
  const Quat light = phototropism(forward, light_on_surface.stableNormalized(), 1 - shoot.light,
                                  parameters.phototropism * dt * light_on_surface.norm());
  const Quat climb = steering(forward, course, parameters.climbing * (1 - std::max(0.0, ease)) * dt);
  return rotation_about(normal, noise) * climb * adapt * light;  // Eq. 8 with two rotations more
}

std::optional<Blocked> in_the_way(const Surroundings& around, const Vec3& head, const Vec3& forward,
                                  double radius, double length) {
  const Vec3 goal = head + length * forward;
  auto next = closest_support(around.obstacles, goal, radius);
  const double height = goal.y() - around.ground_height;
  if (height < (next ? next->distance : radius))
    next = {goal - height * Vec3::UnitY(), Vec3::UnitY(), height};
  if (!next) return {};
  const double into = -next->normal.dot(forward);
  if (into < 0.2) return {};
  return Blocked{next->normal, std::clamp(length - (radius - next->distance) / into, 0.0, length)};
}

Vec3 along(const Blocked& wall, const Vec3& forward, const Vec3& away) {
  const auto on_wall = [&](const Vec3& v) { return Vec3(v - v.dot(wall.normal) * wall.normal); };
  Vec3 way = on_wall(forward);
  if (way.norm() < 0.3) way += on_wall(away);
  return way.norm() > 1e-3 ? way.normalized() : wall.normal.unitOrthogonal();
}

bool grow_tip(Plant& plant, const Shoot& shoot, const ClimberParameters& parameters,
              const Surroundings& around, double wander, double dt) {
  Branch& branch = plant.branches[shoot.branch.index()];
  const ParticleId tip = branch.particles.back();
  Particle& particle = plant.particles[tip.index()];

  const Vec3 head = head_of(plant, tip), forward = forward_of(plant, tip);
  const auto support = closest_support(around.obstacles, head, parameters.tropisms.search_radius);
  const double lit = parameters.shade + (1 - parameters.shade) * shoot.light;
  const double vigour =
      std::clamp(4 * (1 - branch.length / shoot.longest), 0.25, 1.0);  // the last quarter is slow
  double by = std::min(parameters.elongation * lit * vigour * dt,
                       parameters.segment_length - 2 * particle.half_length);
  if (const auto ahead = in_the_way(around, head, forward, particle.half_width, by)) {
    by = ahead->free;
    const Vec3 onwards = along(*ahead, forward, support ? support->normal : around.to_sun);
    turn_segment(plant, tip, steering(forward, onwards, parameters.tropisms.surface_adaption * dt));
  } else {
    turn_segment(
        plant, tip,
        tip_turn(shoot, forward, particle.half_width, support, around, parameters.tropisms, wander, dt));
  }
  lengthen_segment(plant, tip, by);
  branch.length += by;

  // Over an edge, the middle would cut the corner that the head has passed; in a corner, leaving one solid
  // may lead into another: twice.
  for (double part : {-0.5, 0.0, 0.5, 1.0, 0.0, 1.0})
    keep_out(plant, tip, {0, part * particle.half_length, 0}, particle.half_width, around);
  return 2 * particle.half_length >= parameters.segment_length * (1 - 1e-9);
}

}  // namespace liana
