#include "runtime/wind/air/sph_air.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/parallel.h"
#include "runtime/wind/air/sph_kernels.h"

namespace liana {
namespace {

constexpr double kCourant = 0.6;       // of c dt / h; air in a box stays calm up to 1.0
constexpr double kViscous = 1.0 / 15;  // of ν dt / h²: Σ V ∇²W = 15/h², explicit Euler

/// Σ W h-independent: the density of a cubic lattice of unit spacing and mass, by particles nearer than two
/// spacings.
double lattice_density() {
  double sum = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) sum += fixed::pow(4 - (x * x + y * y + z * z), 3);
  return poly6_factor(2) * sum;
}

/// Throws Error{Input} for values out of range.
const AirOptions& checked(const AirOptions& o) {
  const Vec3 extent = o.high - o.low;
  const bool sound = extent.allFinite() && extent.minCoeff() > 0 && o.spacing > 0 && o.rest_density > 0 &&
                     o.sound_speed > 0 && o.viscosity >= 0 && o.capacity > 0 && o.capacity < (1u << 30) &&
                     std::isfinite(o.spacing + o.rest_density + o.sound_speed + o.viscosity) &&
                     extent.maxCoeff() < 1e5 * o.spacing;
  if (!sound)
    throw Error(
        Error::Kind::Input, "the air's domain, spacing, density, speed of sound or viscosity is out of range",
        "positive finite numbers, a domain with low < high in every axis and less than 100000 spacings long");
  return o;
}

double longest_step_of(const AirOptions& o, double support) {
  const double by_sound = kCourant * support / o.sound_speed;
  return o.viscosity > 0 ? std::min(by_sound, kViscous * support * support * o.rest_density / o.viscosity)
                         : by_sound;
}

AirConstants constants_of(const AirOptions& o, double support, double mass) {
  return {static_cast<float>(support), static_cast<float>(mass * poly6_factor(support)),
          static_cast<float>(mass * spiky_factor(support)), static_cast<float>(o.viscosity)};
}

}  // namespace

SphAir::SphAir(const AirOptions& o, const AirWalls* walls, const MovingWalls* moving)
    : options_(checked(o)),
      support_(2 * o.spacing),
      mass_(o.rest_density * fixed::pow(o.spacing, 3) / lattice_density()),
      longest_step_(longest_step_of(o, support_)),
      constants_(constants_of(o, support_, mass_)),
      passes_(sph_passes(o.portable)),
      cells_(o.high - o.low, support_, o.capacity),
      boundary_(walls, moving, cells_, constants_, o.spacing, o.capacity),
      neighbours_(passes_, constants_, o.capacity, o.threads > 0 ? o.threads : default_thread_count()),
      bodies_(o.low, support_, o.rest_density, o.capacity),
      state_(o.capacity + 16),
      sorted_(o.capacity + 16),
      chunk_limited_(neighbours_.chunks()) {}

bool SphAir::add(const Vec3& position, const Vec3& velocity) {
  const Vec3 place = position - options_.low;
  if (count_ == options_.capacity || !velocity.allFinite() || !(place.array() >= 0).all() ||
      !(position.array() < options_.high.array()).all())
    return false;
  const Eigen::Vector3f x = place.cast<float>(), v = velocity.cast<float>();
  if (boundary_.blocks(x)) return false;
  neighbours_.density()[count_] = static_cast<float>(options_.rest_density);
  state_[count_++] = {x.x(), x.y(), x.z(), 0,
                      v.x(), v.y(), v.z(), static_cast<float>(1 / options_.rest_density)};
  return true;
}

void SphAir::push(size_t i, const Vec3& change) {
  AirState& a = state_[i];
  a.vx += static_cast<float>(change.x()), a.vy += static_cast<float>(change.y()),
      a.vz += static_cast<float>(change.z());
}

Vec3 SphAir::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < count_; ++i) sum += velocity(i);
  return mass_ * sum;
}

/// The other states become the present ones, `count` of them and one far away.
void SphAir::swap_in(size_t count) {
  count_ = count;
  state_.swap(sorted_);
  state_[count_] = {AirCells::kFar, AirCells::kFar, AirCells::kFar, 0, 0, 0, 0, 0};
}

void SphAir::sort() {
  const size_t before = count_;
  swap_in(cells_.sort(state_.data(), count_, sorted_.data()));
  left_ += before - count_;
  neighbours_.divide(cells_);
}

void SphAir::step(double dt, std::span<AirBody> bodies) {
  sort();
  if (count_ == 0) return;
  bodies_.find(bodies, cells_);
  if (boundary_.moves()) boundary_.mark_moving(cells_);
  const auto densities = boundary_.moves() ? &SphAir::densities<true> : &SphAir::densities<false>;
  const auto move = boundary_.moves() ? &SphAir::move<true> : &SphAir::move<false>;
  const size_t chunks = neighbours_.chunks();
  parallel_for(chunks, options_.threads, [&](size_t c, unsigned) { (this->*densities)(c); });
  if (!bodies.empty()) bodies_.push(bodies, state_.data(), mass_, dt);
  parallel_for(chunks, options_.threads,
               [&](size_t c, unsigned) { (this->*move)(c, static_cast<float>(dt)); });
  swap_in(count_);
  for (const size_t limited : chunk_limited_) limited_ += limited;
  bodies_.clear();
}

template <bool kMovingWalls>
void SphAir::densities(size_t chunk) {
  const auto rest = static_cast<float>(options_.rest_density);
  const auto stiffness = static_cast<float>(options_.sound_speed * options_.sound_speed);
  float* density = neighbours_.density();
  neighbours_.densities(chunk, cells_, state_.data(), static_cast<int32_t>(count_),
                        [&](uint32_t begin, uint32_t end, uint32_t cell) {
                          for (uint32_t i = begin; i < end; ++i) {
                            AirState& a = state_[i];
                            float rho = density[i] + bodies_.density(i);
                            rho += rest * boundary_.look<kMovingWalls>(i, cell, a);
                            density[i] = rho;
                            a.pressure = stiffness * std::max(rho - rest, 0.0f);
                            a.specific_volume = 1 / rho;
                          }
                        });
}

template <bool kMovingWalls>
void SphAir::move(size_t chunk, float dt) {
  neighbours_.accelerations(chunk, state_.data());
  const auto fastest = static_cast<float>(2 * options_.sound_speed);
  const auto [first, last] = neighbours_.particles(chunk);
  size_t limited = 0;
  for (uint32_t i = first; i < last; ++i) {
    const float *by_air = neighbours_.acceleration() + 4 * size_t{i}, *by_bodies = bodies_.acceleration(i);
    const float acceleration[3] = {by_air[0] + by_bodies[0], by_air[1] + by_bodies[1],
                                   by_air[2] + by_bodies[2]};
    AirState a = state_[i];
    limited += boundary_.move<kMovingWalls>(a, i, dt, acceleration, fastest);
    sorted_[i] = a;
  }
  chunk_limited_[chunk] = limited;
}

}  // namespace liana
