#include "runtime/sim/contact/clearances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace liana {
namespace {

// Bounds may be wider or tighter to the same effect: none of these changes an answer, only what it costs.
constexpr double kMostRoom = 0.03;  // m; below the band of any solid (4 cm), beyond which nothing is known
constexpr double kLeastRoom =
    5e-5;                           // m: a particle at 2 mm/s, which is at rest to the eye, uses it in a step
constexpr double kFloat = 1e-6;     // more than a float is off: 16 roundings of 6e-8
constexpr uint8_t kTryAgain = 8;    // calls: looking in vain costs an eighth of looking in each
constexpr double kRounding = 1e-9;  // m: a double is off by 1e-14 at a hundred metres

/// Half of a box around a particle as probes see it, m: a stem is a cylinder, a blade has its width in the
/// middle and none at its ends.
Vec3 half_box(const Particle& particle, const Quat& orientation, bool blade) {
  const Mat3 axes = orientation.toRotationMatrix();
  const Vec3 along = particle.half_length * axes.col(1).cwiseAbs();
  const Vec3 across =
      ((particle.half_width * axes.col(0)).cwiseAbs2() + (particle.half_thickness * axes.col(2)).cwiseAbs2())
          .cwiseSqrt();
  return blade ? Vec3(along.cwiseMax(across)) : Vec3(along + across);
}

double lever_of(const Particle& particle) {
  return particle.half_length + std::max(particle.half_width, particle.half_thickness);
}

}  // namespace

void Clearances::begin(size_t particles, std::span<const SdfObstacle* const> solids,
                       std::optional<double> ground) {
  bool same = ground == ground_ && states_.size() == solids.size();
  states_.resize(solids.size());
  for (size_t i = 0; i < solids.size(); ++i) {
    const uint64_t state = solids[i]->moves() ? 0 : solids[i]->state();
    same &= states_[i] == state;
    states_[i] = state;
  }
  ground_ = ground;
  if (!same) known_.clear(), wait_.clear();
  known_.resize(particles);
  wait_.resize(particles, 0);
}

// The probes' points start in the particle's box and go no further than `travel`. A gap found on the way is
// then at least least - travel, and Contacts asks whether it closes with up to three times what it comes
// nearer by.
bool Clearances::clear(const Plant& plant, size_t i, double dt) const {
  const Known& known = known_[i];
  if (known.room < 0) return false;
  const Particle& particle = plant.particles[i];
  const Motion& motion = plant.motion[i];
  const double way = moved(known, particle, motion);
  if (dt == 0) return way <= known.room;
  const double travel = dt * (motion.velocity.norm() + lever_of(particle) * motion.angular_velocity.norm() +
                              dt * motion.acceleration.norm() / 2);
  return way + travel <= known.room && 4 * travel <= known.least;
}

// A turn from q to q' moves a point at lever r by 2 r sin(θ/2), where |q - q'| = 2 sin(θ/4).
double Clearances::moved(const Known& known, const Particle& particle, const Motion& motion) {
  const auto& [x, y, z] = known.position;
  const auto& [i, j, k, w] = known.orientation;
  return (motion.position - Vec3(x, y, z)).norm() +
         2 * lever_of(particle) * (motion.orientation.coeffs() - Eigen::Vector4d(i, j, k, w)).norm() +
         std::abs(particle.half_length - known.half[0]) + std::abs(particle.half_width - known.half[1]) +
         std::abs(particle.half_thickness - known.half[2]);
}

double Clearances::least(const Vec3& centre, const Vec3& half,
                         std::span<const SdfObstacle* const> solids) const {
  double least = std::numeric_limits<double>::infinity();
  if (ground_) least = centre.y() - half.y() - *ground_;
  for (const SdfObstacle* solid : solids)
    if (!solid->moves() && least > 0) least = std::min(least, solid->least(centre, half));
  return least - kRounding;
}

void Clearances::learn(const Plant& plant, size_t i, std::span<const SdfObstacle* const> solids) {
  if (wait_[i] > 0) {
    --wait_[i];
    return;
  }
  const Particle& particle = plant.particles[i];
  const Motion& motion = plant.motion[i];
  const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
  const Vec3 half = half_box(particle, motion.orientation, blade);
  Known known;
  // Half of the room for where it may go, the other half for how fast it may come.
  const double room = std::min(kMostRoom, least(motion.position, half, solids) / 2);
  if (room >= kLeastRoom) {
    const auto rounded = [](double number) { return static_cast<float>(number); };
    const Vec3& x = motion.position;
    const Quat& q = motion.orientation;
    known.position = {rounded(x.x()), rounded(x.y()), rounded(x.z())};
    known.orientation = {rounded(q.x()), rounded(q.y()), rounded(q.z()), rounded(q.w())};
    known.half = {rounded(particle.half_length), rounded(particle.half_width),
                  rounded(particle.half_thickness)};
    const double at_least = least(x, half + Vec3::Constant(room + kRounding), solids);
    known.least = rounded(at_least * (1 - kFloat));
    if (at_least > 0) known.room = rounded((room - moved(known, particle, motion)) * (1 - kFloat));
  }
  if (known.room < 0) wait_[i] = kTryAgain;
  known_[i] = known;
}

void Clearances::follow(const Remap& remap) {
  remap.keep_particles(known_);
  remap.keep_particles(wait_);
}

}  // namespace liana
