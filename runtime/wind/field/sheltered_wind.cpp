#include "runtime/wind/field/sheltered_wind.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"

namespace liana {

ShelteredWind::ShelteredWind(const WindField& open, std::vector<const SdfObstacle*> solids,
                             std::optional<double> ground_height, const ShelterParameters& parameters)
    : open_(open),
      solids_(std::move(solids)),
      ground_height_(ground_height),
      parameters_(parameters),
      outermost_(fixed::log1p(parameters.layer / parameters.roughness)) {}

void ShelteredWind::slow(Vec3& wind, double distance, const Vec3& normal) const {
  const double layer = parameters_.layer, roughness = parameters_.roughness;
  if (distance >= layer) return;
  const double inside = std::max(distance, 0.0);
  const double into = wind.dot(normal);
  if (into < 0) wind -= (1 - inside / layer) * into * normal;
  wind *= fixed::log1p(inside / roughness) / outermost_;
}

Vec3 ShelteredWind::velocity(const Vec3& position, double time) const {
  Vec3 wind = open_.velocity(position, time);
  shelter(wind, position);
  return wind;
}

void ShelteredWind::velocities(std::span<const Vec3> positions, double time, std::span<Vec3> out) const {
  open_.velocities(positions, time, out);
  for (size_t i = 0; i < positions.size(); ++i) shelter(out[i], positions[i]);
}

void ShelteredWind::shelter(Vec3& wind, const Vec3& position) const {
  for (const SdfObstacle* solid : solids_) {
    const SdfSample field = solid->sample(position);
    if (field.distance >= parameters_.layer) continue;
    const Vec3 surface = solid->moves() ? solid->velocity_at(position) : Vec3::Zero();
    wind -= surface;
    // Beyond the accurate band the distance is a lower bound: ask exactly there.
    if (std::abs(field.distance) < solid->band()) {
      slow(wind, field.distance, field.gradient);
    } else {
      const SurfacePoint closest = solid->closest_point(position);
      slow(wind, closest.distance, (position - closest.point) / closest.distance);
    }
    wind += surface;
  }
  if (ground_height_) slow(wind, position.y() - *ground_height_, Vec3::UnitY());
}

}  // namespace liana
