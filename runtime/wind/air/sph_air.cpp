#include "runtime/wind/air/sph_air.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "runtime/wind/air/sph_kernels.h"

namespace liana {
namespace {

constexpr float kFar = 1e18f;  // m: where padding is, out of reach of everything and its square still a float
constexpr double kCourant = 0.6;       // of c dt / h; air in a box stays calm up to 1.0
constexpr double kViscous = 1.0 / 15;  // of ν dt / h²: Σ V ∇²W = 15/h², explicit Euler
constexpr int kTasksPerWorker = 4;

/// Σ W h-independent: the density of a cubic lattice of unit spacing and mass, by particles nearer than two
/// spacings.
double lattice_density() {
  double sum = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) sum += std::pow(4 - (x * x + y * y + z * z), 3);
  return poly6_factor(2) * sum;
}

}  // namespace

SphAir::~SphAir() = default;

SphAir::SphAir(const AirOptions& o, const AirWalls* walls, const MovingWalls* moving)
    : options_(o),
      walls_(walls && !walls->empty() ? walls : nullptr),
      moving_(moving && !moving->empty() ? moving : nullptr),
      passes_(sph_passes(o.portable)) {
  options_.threads = o.threads > 0 ? o.threads : default_thread_count();
  start_threads(options_.threads);
  const Vec3 extent = o.high - o.low;
  const bool sound = extent.allFinite() && extent.minCoeff() > 0 && o.spacing > 0 && o.rest_density > 0 &&
                     o.sound_speed > 0 && o.viscosity >= 0 && o.capacity > 0 && o.capacity < (1u << 30) &&
                     std::isfinite(o.spacing + o.rest_density + o.sound_speed + o.viscosity) &&
                     extent.maxCoeff() < 1e5 * o.spacing;
  if (!sound)
    throw Error(
        Error::Kind::Input, "the air's domain, spacing, density, speed of sound or viscosity is out of range",
        "positive finite numbers, a domain with low < high in every axis and less than 100000 spacings long");
  support_ = 2 * o.spacing;
  mass_ = o.rest_density * std::pow(o.spacing, 3) / lattice_density();
  longest_step_ = kCourant * support_ / o.sound_speed;
  if (o.viscosity > 0)
    longest_step_ = std::min(longest_step_, kViscous * support_ * support_ * o.rest_density / o.viscosity);
  constants_ = {static_cast<float>(support_), static_cast<float>(mass_ * poly6_factor(support_)),
                static_cast<float>(mass_ * spiky_factor(support_)), static_cast<float>(o.viscosity)};

  // Cells as wide as the support; wider ones in a domain so large that most would stand empty.
  double cell = support_, number;
  do {
    number = 1;
    for (int k = 0; k < 3; ++k) number *= cells_[k] = static_cast<int>(std::ceil(extent[k] / cell)) + 2;
    cell_size_ = static_cast<float>(cell);
    cell *= 1.25;
  } while (number > std::max<double>(16384, 2.0 * static_cast<double>(o.capacity)));

  const size_t n = o.capacity, padded = n + 16;
  state_.resize(padded), sorted_.resize(padded);
  x_.resize(padded), y_.resize(padded), z_.resize(padded);
  density_.resize(padded), acceleration_.resize(4 * padded);
  extra_density_.resize(padded), extra_acceleration_.resize(4 * padded);
  wall_.resize(padded), key_.resize(padded), list_begin_.resize(padded), list_end_.resize(padded);
  cell_begin_.resize(static_cast<size_t>(number) + 2);
  cell_near_wall_.resize(static_cast<size_t>(number));
  chunks_.resize(kTasksPerWorker * options_.threads);
  for (Chunk& chunk : chunks_) {
    chunk.list.resize(64 * n / chunks_.size() + 65536);
    for (auto* values : {&chunk.x, &chunk.y, &chunk.z}) values->resize(padded);
    chunk.index.resize(padded);
  }
  if (moving_) moving_wall_.resize(padded);
  if (walls_) {
    const float half = 0.87f * cell_size_, reach = static_cast<float>(support_);
    for (int z = 0, i = 0; z < cells_[2]; ++z)
      for (int y = 0; y < cells_[1]; ++y)
        for (int x = 0; x < cells_[0]; ++x, ++i)
          cell_near_wall_[i] = walls_->least_near((x - 0.5f) * cell_size_, (y - 0.5f) * cell_size_,
                                                  (z - 0.5f) * cell_size_, half) < reach
                                   ? kStanding
                                   : 0;
  }
}

int SphAir::cell_along(float x, int axis) const {
  return 1 + static_cast<int>(
                 std::clamp(std::floor(x / cell_size_), -1.0f, static_cast<float>(cells_[axis] - 2)));
}

bool SphAir::add(const Vec3& position, const Vec3& velocity) {
  const Vec3 place = position - options_.low;
  if (count_ == options_.capacity || !velocity.allFinite() || !(place.array() >= 0).all() ||
      !(position.array() < options_.high.array()).all())
    return false;
  const Eigen::Vector3f x = place.cast<float>(), v = velocity.cast<float>();
  const double gap = kWallGap * options_.spacing;
  if (walls_ && walls_->sample(x.x(), x.y(), x.z()).distance < gap) return false;
  if (moving_ && moving_->sample(x.x(), x.y(), x.z()).wall.distance < gap) return false;
  density_[count_] = static_cast<float>(options_.rest_density);
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

// A stable counting sort by cell, which also takes out who left the domain (or is no longer a number).
void SphAir::sort() {
  const Eigen::Vector3f extent = (options_.high - options_.low).cast<float>();
  const auto outside = static_cast<uint32_t>(cell_begin_.size() - 2);
  std::fill(cell_begin_.begin(), cell_begin_.end(), 0u);
  const float per_cell = 1 / cell_size_;
  for (size_t i = 0; i < count_; ++i) {
    const AirState& a = state_[i];
    const bool inside = a.x >= 0 && a.x < extent.x() && a.y >= 0 && a.y < extent.y() && a.z >= 0 &&
                        a.z < extent.z() && std::abs(a.vx + a.vy + a.vz) < kFar;
    uint32_t key = outside;
    if (inside)
      key = (1 + static_cast<uint32_t>(a.x * per_cell)) +
            cells_[0] * ((1 + static_cast<uint32_t>(a.y * per_cell)) +
                         cells_[1] * (1 + static_cast<uint32_t>(a.z * per_cell)));
    key_[i] = key;
    ++cell_begin_[key];
  }
  uint32_t sum = 0;
  for (uint32_t& begin : cell_begin_) sum += std::exchange(begin, sum);
  for (size_t i = 0; i < count_; ++i) {
    const uint32_t to = cell_begin_[key_[i]]++;
    const AirState& a = state_[i];
    sorted_[to] = a;
    x_[to] = a.x, y_[to] = a.y, z_[to] = a.z;
  }
  // Each begin has moved to its end, which is the next one's begin.
  for (size_t k = cell_begin_.size() - 1; k > 0; --k) cell_begin_[k] = cell_begin_[k - 1];
  cell_begin_[0] = 0;
  left_ += count_ - cell_begin_[outside];
  count_ = cell_begin_[outside];
  state_.swap(sorted_);
  state_[count_] = {kFar, kFar, kFar, 0, 0, 0, 0, 0};
  for (size_t i = count_; i < count_ + 8; ++i) x_[i] = y_[i] = z_[i] = kFar;

  uint32_t cell = 0;
  for (size_t c = 0; c < chunks_.size(); ++c) {
    const size_t until = count_ * (c + 1) / chunks_.size();
    chunks_[c].first_cell = cell, chunks_[c].first = cell_begin_[cell];
    while (cell < outside && (cell_begin_[cell] < until || c + 1 == chunks_.size())) ++cell;
    chunks_[c].last_cell = cell, chunks_[c].last = cell_begin_[cell];
    chunks_[c].limited = 0;
  }
}

void SphAir::step(double dt, std::span<AirBody> bodies) {
  sort();
  if (count_ == 0) return;
  find_body_pairs(bodies);
  if (moving_) mark_cells_near_moving();
  parallel_for(chunks_.size(), options_.threads, [&](size_t c, unsigned) { densities(chunks_[c]); });
  if (!body_pairs_.empty()) push_bodies(bodies, dt);
  const auto move = moving_ ? &SphAir::move<true> : &SphAir::move<false>;
  parallel_for(chunks_.size(), options_.threads,
               [&](size_t c, unsigned) { (this->*move)(chunks_[c], static_cast<float>(dt)); });
  state_.swap(sorted_);
  state_[count_] = {kFar, kFar, kFar, 0, 0, 0, 0, 0};
  for (const Chunk& chunk : chunks_) limited_ += chunk.limited;
  for (const BodyPair& pair : body_pairs_) {
    extra_density_[pair.particle] = 0;
    std::fill_n(&extra_acceleration_[4 * pair.particle], 4, 0.0f);
  }
}

void SphAir::densities(Chunk& chunk) {
  const Candidates near{chunk.x.data(), chunk.y.data(), chunk.z.data(), chunk.index.data()};
  const auto finish = moving_ ? &SphAir::finish_density<true> : &SphAir::finish_density<false>;
  uint32_t used = 0;
  for (uint32_t cell = chunk.first_cell; cell < chunk.last_cell; ++cell) {
    const uint32_t begin = cell_begin_[cell], end = cell_begin_[cell + 1];
    if (begin == end) continue;
    uint32_t run_begin[9], run_end[9];
    for (int run = 0; run < 9; ++run) {
      const uint32_t row = cell + cells_[0] * (run % 3 - 1 + cells_[1] * (run / 3 - 1));
      run_begin[run] = cell_begin_[row - 1], run_end[run] = cell_begin_[row + 2];
    }
    const uint32_t count =
        passes_.gather(begin, end, run_begin, run_end, constants_, x_.data(), y_.data(), z_.data(), near);
    const size_t room = used + size_t(end - begin) * (count + 16);
    if (chunk.list.size() < room) chunk.list.resize(2 * room);
    used = passes_.density(begin, end, near, count, static_cast<int32_t>(count_), constants_, state_.data(),
                           density_.data(), list_begin_.data(), list_end_.data(), chunk.list.data(), used);
    (this->*finish)(begin, end, cell_near_wall_[cell]);
  }
}

template <bool kMovingWalls>
void SphAir::finish_density(uint32_t begin, uint32_t end, uint8_t near_wall) {
  const auto rest = static_cast<float>(options_.rest_density), h = constants_.support;
  const auto stiffness = static_cast<float>(options_.sound_speed * options_.sound_speed);
  for (uint32_t i = begin; i < end; ++i) {
    AirState& a = state_[i];
    float rho = density_[i] + extra_density_[i];
    wall_[i].distance = h;
    float share = 0;  // of the kernel that is wall
    if (near_wall & kStanding) {
      wall_[i] = walls_->sample(a.x, a.y, a.z);
      if (wall_[i].distance < h) share = static_cast<float>(wall_integrals(wall_[i].distance / h).density);
    }
    if constexpr (kMovingWalls) share += feel_moving(i, near_wall, share);
    rho += rest * share;
    density_[i] = rho;
    a.pressure = stiffness * std::max(rho - rest, 0.0f);
    a.specific_volume = 1 / rho;
  }
}

template <bool kMovingWalls>
void SphAir::move(Chunk& chunk, float dt) {
  passes_.force(chunk.first, chunk.last, constants_, state_.data(), list_begin_.data(), list_end_.data(),
                chunk.list.data(), acceleration_.data());
  const float h = constants_.support, gap = static_cast<float>(kWallGap * options_.spacing);
  const auto fastest = static_cast<float>(2 * options_.sound_speed);
  for (uint32_t i = chunk.first; i < chunk.last; ++i) {
    AirState a = state_[i];
    const AirWalls::Sample& wall = wall_[i];
    float push = 0, hold = 1;  // m/s away from the wall; what its friction leaves of the velocity
    if (wall.distance < h) {
      const WallIntegrals integrals = wall_integrals(wall.distance / h);
      push = dt * a.pressure * a.specific_volume * static_cast<float>(integrals.pressure) / h;
      const float rub =
          dt * constants_.viscosity * a.specific_volume * static_cast<float>(integrals.viscosity) / (h * h);
      hold = 1 / (1 + rub);
    }
    a.vx = (a.vx + dt * (acceleration_[4 * i] + extra_acceleration_[4 * i])) * hold + push * wall.x;
    a.vy = (a.vy + dt * (acceleration_[4 * i + 1] + extra_acceleration_[4 * i + 1])) * hold + push * wall.y;
    a.vz = (a.vz + dt * (acceleration_[4 * i + 2] + extra_acceleration_[4 * i + 2])) * hold + push * wall.z;
    if constexpr (kMovingWalls) push_off_moving(a, i, dt);
    const float speed = std::sqrt(a.vx * a.vx + a.vy * a.vy + a.vz * a.vz);
    if (speed > fastest) {
      const float cut = fastest / speed;
      a.vx *= cut, a.vy *= cut, a.vz *= cut;
      ++chunk.limited;
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
    if constexpr (kMovingWalls) keep_out_of_moving(a, i, dt);
    sorted_[i] = a;
  }
}

}  // namespace liana
