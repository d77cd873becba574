#include "runtime/wind/air/air_boundary.h"

#include <algorithm>

namespace liana {

AirBoundary::AirBoundary(const AirWalls* standing, const MovingWalls* moving, const AirCells& cells,
                         const AirConstants& constants, double spacing, size_t capacity)
    : standing_(standing && !standing->empty() ? standing : nullptr),
      moving_(moving && !moving->empty() ? moving : nullptr),
      constants_(constants),
      gap_(kWallGap * spacing),
      cell_near_(cells.size()),
      wall_(capacity + 16),
      moving_wall_(moving_ ? capacity + 16 : 0) {
  if (!standing_) return;
  const float half = 0.87f * cells.width(), reach = constants.support;
  const auto& number = cells.number();
  for (int z = 0, i = 0; z < number[2]; ++z)
    for (int y = 0; y < number[1]; ++y)
      for (int x = 0; x < number[0]; ++x, ++i)
        cell_near_[i] = standing_->least_near((x - 0.5f) * cells.width(), (y - 0.5f) * cells.width(),
                                              (z - 0.5f) * cells.width(), half) < reach
                            ? kStanding
                            : 0;
}

bool AirBoundary::blocks(const Eigen::Vector3f& x) const {
  return (standing_ && standing_->sample(x.x(), x.y(), x.z()).distance < gap_) ||
         (moving_ && moving_->sample(x.x(), x.y(), x.z()).wall.distance < gap_);
}

void AirBoundary::mark_moving(const AirCells& cells) {
  for (uint8_t& near : cell_near_) near &= kStanding;
  const float width = cells.width(), reach = constants_.support + 0.87f * width;
  const auto& number = cells.number();
  for (size_t wall = 0; wall < moving_->size(); ++wall) {
    int first[3], last[3];
    for (int k = 0; k < 3; ++k) {
      first[k] = cells.along(moving_->low(wall)[k], k), last[k] = cells.along(moving_->high(wall)[k], k);
    }
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) {
          const size_t cell = x + size_t(number[0]) * (y + size_t(number[1]) * z);
          if (cells.begin(cell) == cells.begin(cell + 1) || cell_near_[cell] & kMoving) continue;
          const float distance =
              moving_->sample((x - 0.5f) * width, (y - 0.5f) * width, (z - 0.5f) * width).wall.distance;
          if (distance < reach) cell_near_[cell] |= kMoving;
        }
  }
}

/// Looks where particle i's moving wall is; the share of its kernel in it, less what `share` has already.
float AirBoundary::look_moving(uint32_t i, uint8_t near, const AirState& a, float share) {
  const float h = constants_.support;
  moving_wall_[i].wall.distance = h;
  if (!(near & kMoving)) return 0;
  moving_wall_[i] = moving_->sample(a.x, a.y, a.z);
  if (moving_wall_[i].wall.distance >= h) return 0;
  // Exact for walls that face each other far away or stand upright on each other at the particle.
  return (1 - share) * static_cast<float>(wall_integrals(moving_wall_[i].wall.distance / h).density);
}

void AirBoundary::push_off_moving(AirState& a, uint32_t i, float dt) const {
  const MovingWalls::Sample& moving = moving_wall_[i];
  const AirWalls::Sample& wall = moving.wall;
  const float h = constants_.support;
  if (wall.distance >= h) return;
  const WallIntegrals integrals = wall_integrals(wall.distance / h);
  const float push = dt * a.pressure * a.specific_volume * static_cast<float>(integrals.pressure) / h;
  const float rub =
      dt * constants_.viscosity * a.specific_volume * static_cast<float>(integrals.viscosity) / (h * h);
  const float hold = 1 / (1 + rub);
  a.vx = moving.vx + (a.vx - moving.vx) * hold + push * wall.x;
  a.vy = moving.vy + (a.vy - moving.vy) * hold + push * wall.y;
  a.vz = moving.vz + (a.vz - moving.vz) * hold + push * wall.z;
}

/// After its step. What is deeper in a solid than the wall could have come is taken out, and so is what has
/// no room between it and another wall.
void AirBoundary::keep_out_of_moving(AirState& a, const AirState& was, uint32_t i, float dt) const {
  const MovingWalls::Sample& moving = moving_wall_[i];
  const AirWalls::Sample& wall = moving.wall;
  if (wall.distance >= constants_.support) return;
  const float gap = static_cast<float>(gap_);
  const float way = (a.x - was.x - dt * moving.vx) * wall.x + (a.y - was.y - dt * moving.vy) * wall.y +
                    (a.z - was.z - dt * moving.vz) * wall.z;
  const float out = gap - (wall.distance + way);
  bool crushed = wall.distance < -gap;
  if (out > 0) {
    a.x += out * wall.x, a.y += out * wall.y, a.z += out * wall.z;
    const float away =
        (a.vx - moving.vx) * wall.x + (a.vy - moving.vy) * wall.y + (a.vz - moving.vz) * wall.z;
    const float stop = std::min(away, 0.0f);
    a.vx -= stop * wall.x, a.vy -= stop * wall.y, a.vz -= stop * wall.z;
    const AirWalls::Sample& other = wall_[i];
    crushed |=
        other.distance < constants_.support &&
        other.distance + (a.x - was.x) * other.x + (a.y - was.y) * other.y + (a.z - was.z) * other.z < 0;
  }
  if (crushed) a.x = -1;  // outside of the domain
}

}  // namespace liana
