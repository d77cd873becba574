#include "runtime/picture/picking.h"

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

/// Distance along the ray to the first triangle (m), infinity without one.
double first_hit(const Ray& ray, std::span<const DrawMesh> obstacles) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const DrawMesh& obstacle : obstacles)
    for (const Triangle& t : obstacle.mesh.triangles) {
      const Vec3& a = obstacle.mesh.positions[t[0]];
      const Vec3 u = obstacle.mesh.positions[t[1]] - a, v = obstacle.mesh.positions[t[2]] - a;
      // a + s u + t v = origin + d direction by Cramer's rule; the determinant is the triangle's area seen
      // end-on.
      const Vec3 cross = ray.direction.cross(v), offset = ray.origin - a, other = offset.cross(u);
      const double volume = u.dot(cross);
      if (volume == 0) continue;
      const double s = offset.dot(cross) / volume, r = ray.direction.dot(other) / volume,
                   d = v.dot(other) / volume;
      if (s >= 0 && r >= 0 && s + r <= 1 && d > 0) nearest = std::min(nearest, d);
    }
  return nearest;
}

}  // namespace

Passing closest_passing(const Ray& ray, const Vec3& start, const Vec3& end) {
  const Vec3 axis = end - start, offset = start - ray.origin;
  const double length2 = axis.squaredNorm(), b = axis.dot(ray.direction);
  const double apart = length2 - b * b;  // zero when parallel
  double s = apart > 1e-12 * length2 ? (b * ray.direction.dot(offset) - axis.dot(offset)) / apart : 0;
  s = std::clamp(s, 0.0, 1.0);
  const double along = std::max(0.0, ray.direction.dot(offset + s * axis));
  return {along, s, (offset + s * axis - along * ray.direction).norm()};
}

std::optional<Pick> pick_particle(const Simulation& simulation, std::span<const DrawMesh> obstacles,
                                  const Camera& camera, double x, double y, int width, int height,
                                  double tolerance) {
  const Ray ray = camera.ray(x, y, width, height);
  const double wall = first_hit(ray, obstacles);
  std::optional<Pick> best;
  double best_miss = tolerance, best_along = std::numeric_limits<double>::infinity();
  for (size_t p = 0; p < simulation.plant_count(); ++p) {
    const Plant& plant = simulation.plant(p);
    for (size_t i = 0; i < plant.particles.size(); ++i) {
      const Particle& particle = plant.particles[i];
      const Motion& motion = plant.motion[i];
      const Vec3 half = motion.orientation * Vec3(0, particle.half_length, 0);
      const Passing passing = closest_passing(ray, motion.position - half, motion.position + half);
      const double depth = passing.along_ray * ray.direction.dot(camera.forward());
      // A stem lies against its wall: it still counts as in front of it by its own thickness.
      if (depth < camera.near_plane() || passing.along_ray > wall + particle.half_width + 0.01) continue;
      const double miss =
          std::max(0.0, passing.distance - particle.half_width) / camera.pixel_size(depth, height);
      if (miss > best_miss || (miss == best_miss && passing.along_ray >= best_along)) continue;
      best_miss = miss;
      best_along = passing.along_ray;
      const Vec3 local(0, (2 * passing.along_segment - 1) * particle.half_length, 0);
      best = Pick{p, ParticleId(i), local, motion.position + motion.orientation * local};
    }
  }
  return best;
}

}  // namespace liana
