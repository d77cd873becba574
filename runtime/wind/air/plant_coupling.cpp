#include "runtime/wind/air/plant_coupling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "mesher/base/parallel.h"

namespace liana {
namespace {

constexpr size_t kBlock = 256;   // particles of a task
constexpr double kThick = 0.01;  // of an air particle's volume: thinner bodies are not felt as volumes
constexpr double kConeFactor = 3 / kPi;  // of 1 - |η|, for a unit integral over the unit ball

Vec3 half_axes(const Particle& particle) {
  return {particle.half_width, particle.half_length, particle.half_thickness};
}

/// The mean of the velocities at the ends of a step's parts, less what the dashpot's mixing by α_f adds: what
/// makes factor * (air - this) * dt the dashpot's impulse. Exact when the scheme takes the step in one part.
Vec3 mean_velocity(const TimeScheme& scheme, const Vec3& before, const Vec3& after) {
  const double n = scheme.substeps, rho = scheme.rho_infinity;
  const double alpha_over = rho;  // α_f / (1 - α_f), with α_f = ρ∞ / (1 + ρ∞)
  return before + ((n + 1) / (2 * n) + alpha_over * (n - 1) / (2 * n)) * (after - before);
}

}  // namespace

std::span<AirBody> PlantCoupling::set_bodies(std::span<const PlantInWind> plants) {
  bodies_.clear(), body_of_.clear();
  const double least = kThick * fixed::pow(air_.options().spacing, 3);
  for (size_t p = 0; p < plants.size(); ++p) {
    const Plant& plant = *plants[p].plant;
    for (size_t i = 0; i < plant.particles.size(); ++i) {
      const Vec3 axes = half_axes(plant.particles[i]);
      if (4 * kPi / 3 * axes.prod() < least || (!plants[p].growing.empty() && plants[p].growing[i])) continue;
      bodies_.push_back({plant.motion[i].position, plant.motion[i].orientation, axes});
      body_of_.emplace_back(p, ParticleId(i));
    }
  }
  return bodies_;
}

void PlantCoupling::make_blocks(std::span<const PlantInWind> plants) {
  first_block_.clear();
  size_t count = 0;
  for (size_t p = 0; p < plants.size(); ++p) {
    first_block_.push_back(count);
    const size_t n = plants[p].plant->particles.size();
    for (size_t first = 0; first < n; first += kBlock, ++count) {
      if (blocks_.size() == count) blocks_.emplace_back();
      Block& block = blocks_[count];
      block.plant = p;
      block.first = static_cast<uint32_t>(first);
      block.last = static_cast<uint32_t>(std::min(n, first + kBlock));
      block.targets.clear();
    }
  }
  first_block_.push_back(count);
}

void PlantCoupling::find(std::span<const PlantInWind> plants, const WindField* ambient, double time,
                         double dt) {
  dt_ = dt;
  make_blocks(plants);
  const size_t count = first_block_.back(), n = air_.size();
  load_.assign(n, 0.0f);
  const unsigned threads = air_.options().threads;
  parallel_for(count, threads,
               [&](size_t b, unsigned) { find_pairs(blocks_[b], plants[blocks_[b].plant], ambient, time); });
  const auto per_mass = static_cast<float>(dt_ / air_.particle_mass());
  for (size_t b = 0; b < count; ++b) {
    const Block& block = blocks_[b];
    const uint32_t pairs = block.targets.empty() ? 0 : block.targets.back().last;
    for (uint32_t k = 0; k < pairs; ++k) load_[block.air[k]] += per_mass * block.weight[k];
  }
  parallel_for(count, threads, [&](size_t b, unsigned) { settle(blocks_[b]); });
}

void PlantCoupling::find_pairs(Block& block, const PlantInWind& in, const WindField* ambient, double time) {
  const Plant& plant = *in.plant;
  const double h = air_.support();
  std::array<Vec3, kBlock> places, still_air;
  const size_t count = block.last - block.first;
  for (size_t i = 0; i < count; ++i) places[i] = plant.motion[block.first + i].position;
  still_air.fill(Vec3::Zero());
  if (ambient) ambient->velocities({places.data(), count}, time, {still_air.data(), count});

  uint32_t used = 0;
  for (size_t i = 0; i < count; ++i) {
    const ParticleId id(block.first + i);
    const Motion& motion = plant.motion[id.index()];
    Target target{id, used, used, still_air[i], 0, motion.velocity, 0, Vec3::Zero()};
    double cover = 0, sum = 0;
    Vec3 flow = Vec3::Zero();
    if (in.growing.empty() || !in.growing[id.index()]) {
      const Vec3 reach = half_axes(plant.particles[id.index()]) + Vec3::Constant(h);
      const Mat3 to_world = motion.orientation.toRotationMatrix();
      const Mat3 G = reach.cwiseInverse().asDiagonal() * to_world.transpose();
      const Vec3 from_corner = motion.position - air_.options().low;
      const Eigen::Vector3f box = (to_world.cwiseAbs2() * reach.cwiseAbs2()).cwiseSqrt().cast<float>(),
                            place = from_corner.cast<float>();
      const float centre[3] = {place.x(), place.y(), place.z()};
      float rows[9];
      for (int k = 0; k < 9; ++k) rows[k] = static_cast<float>(G(k / 3, k % 3));
      air_.cells().for_ranges(place - box, place + box, [&](uint32_t begin, uint32_t end) {
        const size_t room = used + (end - begin) + 16;
        if (block.air.size() < room) block.air.resize(2 * room), block.weight.resize(2 * room);
        used = air_.passes().ellipsoid(begin, end, air_.cells().xs(), air_.cells().ys(), air_.cells().zs(),
                                       centre, rows, block.air.data(), block.weight.data(), used);
      });
      for (uint32_t k = target.first; k < used; ++k) {
        const AirState& a = air_.states()[block.air[k]];
        block.weight[k] *= a.specific_volume;
        sum += block.weight[k];
        flow += block.weight[k] * Vec3(a.vx, a.vy, a.vz);
      }
      cover = std::min(1.0, kConeFactor * air_.particle_mass() * sum / reach.prod());
    }
    target.last = used;
    if (sum > 0) flow /= sum;
    const Vec3 relative = target.ambient + (ambient ? cover : 1.0) * flow - motion.velocity;
    const double drag = cover > 0 || ambient ? drag_factor(plant, id, relative, drag_) : 0;
    target.still = ambient ? (1 - cover) * drag : 0;
    const auto scale = static_cast<float>(sum > 0 ? cover * drag / sum : 0);
    for (uint32_t k = target.first; k < used; ++k) block.weight[k] *= scale;
    if (drag > 0)
      block.targets.push_back(target);
    else
      used = target.first;
  }
}

void PlantCoupling::settle(Block& block) {
  for (Target& target : block.targets) {
    for (uint32_t k = target.first; k < target.last; ++k) {
      const AirState& a = air_.states()[block.air[k]];
      float& strength = block.weight[k];
      strength /= 1 + load_[block.air[k]];
      target.own += strength;
      target.drive += double(strength) * Vec3(a.vx, a.vy, a.vz);
    }
  }
}

void PlantCoupling::dashpots(size_t index, const Plant& plant, std::vector<WorldSpring>& springs) const {
  for (size_t b = first_block_[index]; b < first_block_[index + 1]; ++b)
    for (const Target& target : blocks_[b].targets) {
      const double factor = target.own + target.still;
      if (factor <= 0) continue;
      springs.push_back(drag_dashpot(plant, target.particle, factor, target.ambient + target.drive / factor));
    }
}

void PlantCoupling::add_pressure(size_t index, std::span<Wrench> wrenches) const {
  for (size_t b = 0; b < bodies_.size(); ++b)
    if (body_of_[b].first == index) wrenches[body_of_[b].second.index()].force += bodies_[b].impulse / dt_;
}

void PlantCoupling::react(std::span<const PlantInWind> plants) {
  exchanged_ = Vec3::Zero();
  change_.assign(4 * air_.size(), 0.0f);
  for (size_t b = 0; b < first_block_.back(); ++b) {
    const Block& block = blocks_[b];
    const Plant& plant = *plants[block.plant].plant;
    for (const Target& target : block.targets) {
      if (target.own == 0) continue;
      const Vec3 after = plant.motion[target.particle.index()].velocity;
      const Vec3 slip = target.ambient - mean_velocity(plant.scheme, target.velocity, after);
      exchanged_ += dt_ * (target.drive + target.own * slip);
      const float x = static_cast<float>(slip.x()), y = static_cast<float>(slip.y()),
                  z = static_cast<float>(slip.z());
      for (uint32_t k = target.first; k < target.last; ++k) {
        const AirState& a = air_.states()[block.air[k]];
        float* change = &change_[4 * block.air[k]];
        change[0] += block.weight[k] * (a.vx + x);
        change[1] += block.weight[k] * (a.vy + y);
        change[2] += block.weight[k] * (a.vz + z);
      }
    }
  }
  const double per_mass = dt_ / air_.particle_mass();
  for (size_t j = 0; j < air_.size(); ++j)
    air_.push(j, -per_mass * Vec3(change_[4 * j], change_[4 * j + 1], change_[4 * j + 2]));
}

size_t PlantCoupling::pairs() const {
  size_t sum = 0;
  for (size_t b = 0; b < first_block_.back(); ++b)
    for (const Target& target : blocks_[b].targets) sum += target.last - target.first;
  return sum;
}

}  // namespace liana
