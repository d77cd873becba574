// What solids do to the air near them: those that stand still and those that move.
//
//   d  distance of a particle from a solid's surface, m     h  support of the kernels, m
//   a solid counts as filled with air of rest density: closed forms of its share in each kernel
//   (sph_kernels.h)
#pragma once

#include <vector>

#include "runtime/wind/air/air_cells.h"
#include "runtime/wind/air/moving_walls.h"
#include "runtime/wind/air/sph_kernels.h"

namespace liana {

class AirBoundary {
 public:
  /// Null: none. Both must outlive it. spacing: of the air, m.
  AirBoundary(const AirWalls* standing, const MovingWalls* moving, const AirCells& cells,
              const AirConstants& constants, double spacing, size_t capacity);

  bool moves() const { return moving_ != nullptr; }
  /// Whether a new particle has no room at a place (m from the domain's low corner).
  bool blocks(const Eigen::Vector3f& place) const;
  /// Before a step: looks which cells moving walls are near.
  void mark_moving(const AirCells& cells);
  /// Looks where the walls of particle i of a cell are; the share of its kernel that is wall.
  template <bool kMovingWalls>
  float look(uint32_t i, size_t cell, const AirState& a);
  /// A step of dt (s) with this acceleration (m/s²), pressed and rubbed by walls. fastest: m/s. True when it
  /// had to be slowed down to that.
  template <bool kMovingWalls>
  bool move(AirState& a, uint32_t i, float dt, const float (&acceleration)[3], float fastest) const;

 private:
  static constexpr uint8_t kStanding = 1, kMoving = 2;
  static constexpr double kWallGap = 0.25;  // of the spacing: nearer to a solid no particle comes
  float look_moving(uint32_t i, uint8_t near, const AirState& a, float share);
  void push_off_moving(AirState& a, uint32_t i, float dt) const;
  void keep_out_of_moving(AirState& a, const AirState& was, uint32_t i, float dt) const;

  const AirWalls* standing_;
  const MovingWalls* moving_;
  AirConstants constants_;
  double gap_;                                    // m
  std::vector<uint8_t> cell_near_;                // of kStanding and kMoving
  std::vector<AirWalls::Sample> wall_;            // per particle
  std::vector<MovingWalls::Sample> moving_wall_;  // per particle, if any move
};

template <bool kMovingWalls>
float AirBoundary::look(uint32_t i, size_t cell, const AirState& a) {
  const float h = constants_.support;
  const uint8_t near = cell_near_[cell];
  wall_[i] = {h, 0, 0, 0};
  float share = 0;
  if (near & kStanding) {
    wall_[i] = standing_->sample(a.x, a.y, a.z);
    if (wall_[i].distance < h) share = static_cast<float>(wall_integrals(wall_[i].distance / h).density);
  }
  if constexpr (kMovingWalls) share += look_moving(i, near, a, share);
  return share;
}

template <bool kMovingWalls>
bool AirBoundary::move(AirState& a, uint32_t i, float dt, const float (&acceleration)[3],
                       float fastest) const {
  const AirState was = a;
  const AirWalls::Sample& wall = wall_[i];
  const float h = constants_.support, gap = static_cast<float>(gap_);
  float push = 0, hold = 1;  // m/s away from the wall; what its friction leaves of the velocity
  if (wall.distance < h) {
    const WallIntegrals integrals = wall_integrals(wall.distance / h);
    push = dt * a.pressure * a.specific_volume * static_cast<float>(integrals.pressure) / h;
    const float rub =
        dt * constants_.viscosity * a.specific_volume * static_cast<float>(integrals.viscosity) / (h * h);
    hold = 1 / (1 + rub);
  }
  a.vx = (a.vx + dt * acceleration[0]) * hold + push * wall.x;
  a.vy = (a.vy + dt * acceleration[1]) * hold + push * wall.y;
  a.vz = (a.vz + dt * acceleration[2]) * hold + push * wall.z;
  if constexpr (kMovingWalls) push_off_moving(a, i, dt);
  const float speed = std::sqrt(a.vx * a.vx + a.vy * a.vy + a.vz * a.vz);
  const bool limited = speed > fastest;
  if (limited) {
    const float cut = fastest / speed;
    a.vx *= cut, a.vy *= cut, a.vz *= cut;
  }
  a.x += dt * a.vx, a.y += dt * a.vy, a.z += dt * a.vz;
  if (wall.distance < h) {
    const float away = a.vx * wall.x + a.vy * wall.y + a.vz * wall.z;
    const float out = gap - (wall.distance + dt * away);
    if (out > 0) {
      a.x += out * wall.x, a.y += out * wall.y, a.z += out * wall.z;
      const float stop = std::min(away, 0.0f);
      a.vx -= stop * wall.x, a.vy -= stop * wall.y, a.vz -= stop * wall.z;
    }
  }
  if constexpr (kMovingWalls) keep_out_of_moving(a, was, i, dt);
  return limited;
}

}  // namespace liana
