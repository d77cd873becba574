// Wind as it is near solid surfaces: slower, and along them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/obstacles/sdf_obstacle.h"
#include "runtime/wind/field/wind_field.h"

namespace liana {

struct ShelterParameters {
  double layer = 0.3;       ///< m, beyond which a surface is not felt
  double roughness = 4e-3;  ///< m, of the surface: leaves on it, say
};

/// Another wind slowed towards each surface by the logarithmic law u(d) = u ln(1 + d/z₀) / ln(1 + δ/z₀),
/// without its part into the surface close to it (air does not blow through a wall). Zero inside solids.
/// Where a surface moves, u is relative to it: it takes the air along. The solids must outlive it.
class ShelteredWind : public WindField {
 public:
  ShelteredWind(const WindField& open, std::vector<const SdfObstacle*> solids,
                std::optional<double> ground_height, const ShelterParameters& parameters = {});
  Vec3 velocity(const Vec3& position, double time) const override;
  void velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const override;

 private:
  void shelter(Vec3& wind, const Vec3& position) const;
  void slow(Vec3& wind, double distance, const Vec3& normal) const;

  const WindField& open_;
  std::vector<const SdfObstacle*> solids_;
  std::optional<double> ground_height_;
  ShelterParameters parameters_;
  double outermost_;  // ln(1 + δ/z₀)
};

}  // namespace liana
