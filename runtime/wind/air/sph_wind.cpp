#include "runtime/wind/air/sph_wind.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "runtime/wind/air/sph_kernels.h"

namespace liana {
namespace {

constexpr double kWallWay = 0.5;       // of the spacing: farther no wall moves in a substep
constexpr double kMostForWalls = 100;  // substeps; what is faster runs over air rather than pushing it

std::vector<Emitter> emitters_of(const SphWindParameters& p) {
  std::vector<Emitter> emitters;
  for (size_t i = 0; i < p.emitters.size(); ++i) emitters.emplace_back(p.emitters[i], p.seed + i);
  return emitters;
}

AirOptions air_of(const SphWindParameters& p, const std::vector<Emitter>& emitters) {
  if (emitters.empty())
    throw Error(Error::Kind::Input, "a wind of air particles has no emitter",
                "add one: a disc or a box that blows");
  if (!(p.sound_over_speed >= 1 && p.sound_over_speed <= 20 && p.viscosity_ratio >= 0 &&
        p.viscosity_ratio <= 1))
    throw Error(Error::Kind::Input, "the air's speed of sound or viscosity is out of range",
                "sound_over_speed 1-20, viscosity_ratio 0-1");
  double top = 0;
  for (const Emitter& emitter : emitters) top = std::max(top, emitter.top_speed());
  AirOptions air;
  air.low = p.low, air.high = p.high;
  air.spacing = p.spacing;
  air.rest_density = p.air_density;
  air.sound_speed = p.sound_over_speed * top;
  air.viscosity = p.viscosity_ratio * p.air_density * air.sound_speed * 2 * p.spacing;
  air.capacity = p.max_particles;
  air.threads = p.threads;
  air.portable = p.portable;
  return air;
}

}  // namespace

SphWind::SphWind(const SphWindParameters& p, std::span<const SdfObstacle* const> solids,
                 std::optional<double> ground_height, std::span<const SdfObstacle* const> moving)
    : emitters_(emitters_of(p)),
      // Beyond the support by a cell's diagonal, so that cells far from solids are known as such.
      walls_(p.low, p.high, p.spacing / 2, 4 * p.spacing, solids, ground_height, p.threads),
      moving_(p.low, p.spacing / 2, 4 * p.spacing, moving, p.threads),
      air_(air_of(p, emitters_), &walls_, &moving_) {
  air_.sort();
}

int SphWind::substeps(double dt) const {
  const double by_air = dt / air_.longest_step();
  const double by_walls =
      moving_.empty() ? 0 : dt * moving_.top_speed(air_.options().high) / (kWallWay * air_.options().spacing);
  return std::max(1, static_cast<int>(std::ceil(std::max(by_air, std::min(by_walls, kMostForWalls)) - 1e-9)));
}

void SphWind::step(double dt, std::span<AirBody> bodies) {
  const int parts = substeps(dt);
  const double h = dt / parts;
  for (int part = 0; part < parts; ++part) {
    moving_.place(dt - part * h);
    for (Emitter& emitter : emitters_) {
      const size_t before = air_.size();
      report_.refused += emitter.emit(air_, time_, h);
      report_.emitted += air_.size() - before;
    }
    air_.step(h, bodies);
    time_ += h;
    ++report_.substeps;
  }
  air_.sort();
}

Vec3 SphWind::velocity(const Vec3& position, double) const {
  const double h = air_.support(), factor = poly6_factor(h) * air_.particle_mass();
  const Eigen::Vector3f x = (position - air_.options().low).cast<float>();
  const auto reach = Eigen::Vector3f::Constant(static_cast<float>(h));
  if (((position - air_.options().low).array() < -h).any() ||
      ((position - air_.options().high).array() > h).any())
    return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  double cover = 0;
  air_.cells().for_ranges(x - reach, x + reach, [&](uint32_t begin, uint32_t end) {
    for (uint32_t j = begin; j < end; ++j) {
      const AirState& a = air_.states()[j];
      const double left = h * h - (Eigen::Vector3f(a.x, a.y, a.z) - x).squaredNorm();
      if (left <= 0) continue;
      const double share = factor * a.specific_volume * left * left * left;
      sum += share * Vec3(a.vx, a.vy, a.vz);
      cover += share;
    }
  });
  return sum / std::max(1.0, cover);
}

SphWindReport SphWind::report() const {
  SphWindReport report = report_;
  report.particles = air_.size();
  report.left = air_.left();
  report.limited = air_.limited();
  return report;
}

}  // namespace liana
