// Solid bodies in the air: anisotropic kernels, [Haedrich17] Eq. 13.
#pragma once

#include <span>
#include <vector>

#include "runtime/wind/air/air_cells.h"

namespace liana {

/// A solid ellipsoid in the air whose volume displaces it: a thick piece of a plant.
struct AirBody {
  Vec3 position;  ///< m
  Quat orientation;
  Vec3 half_axes;               ///< m, along its own axes
  Vec3 impulse = Vec3::Zero();  ///< N·s, what the air's pressure gave it so far
};

/// What bodies add to each air particle in one step.
class AirBodies {
 public:
  /// m and kg/m³.
  AirBodies(const Vec3& domain_low, double support, double rest_density, size_t capacity);

  /// The pairs of bodies and sorted air particles near them, and the density that these add.
  void find(std::span<const AirBody> bodies, const AirCells& cells);
  /// Pressure between them over dt (s): accelerations of the air, impulses of the bodies. mass: of an air
  /// particle, kg.
  void push(std::span<AirBody> bodies, const AirState* state, double mass, double dt);
  /// After the step.
  void clear();

  float density(uint32_t particle) const { return density_[particle]; }                        ///< kg/m³
  const float* acceleration(uint32_t particle) const { return &acceleration_[4 * particle]; }  ///< m/s²

 private:
  struct Pair {
    uint32_t body, particle;
    float volume_gradient[3];  // V_b ∇W, 1/m
  };
  Vec3 low_;
  double support_, rest_density_;
  std::vector<Pair> pairs_;
  std::vector<float> density_, acceleration_;  // zero but for those of pairs_; four a particle
};

}  // namespace liana
