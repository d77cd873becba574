// What is under the mouse.
#pragma once

#include <optional>
#include <span>

#include "runtime/picture/camera.h"
#include "runtime/picture/simulation_view.h"

namespace liana {

struct Pick {
  size_t plant = 0;  ///< index into the simulation's plants
  ParticleId particle;
  Vec3 on_particle = Vec3::Zero();  ///< in the particle's frame: a point of its axis, m
  Vec3 point = Vec3::Zero();        ///< the same in the world
};

/// Where two lines pass each other.
struct Passing {
  double along_ray;      ///< m from the ray's origin, >= 0
  double along_segment;  ///< 0 at its start, 1 at its end
  double distance;       ///< m
};
Passing closest_passing(const Ray& ray, const Vec3& start, const Vec3& end);

/// The particle whose axis passes the pixel within its own half width or `tolerance` pixels: the one nearest
/// to the pixel in pixels beyond its width, and among those right under it the one nearest to the eye. What
/// stands behind a mesh of `obstacles` is not picked.
std::optional<Pick> pick_particle(const Simulation& simulation, std::span<const DrawMesh> obstacles,
                                  const Camera& camera, double x, double y, int width, int height,
                                  double tolerance = 8);

}  // namespace liana
