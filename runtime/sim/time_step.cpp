#include "runtime/sim/time_step.h"

#include <cstddef>

#include "runtime/sim/generalized_alpha.h"
#include "runtime/sim/joints.h"

namespace liana {
namespace {

// The kernels read these structures as rows of numbers.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double));
static_assert(sizeof(Particle) == lanes::kParticleStride * sizeof(double));
static_assert(offsetof(Particle, half_length) == 1 * sizeof(double));
static_assert(offsetof(Particle, mass) == 4 * sizeof(double));
static_assert(offsetof(Particle, inertia) == 5 * sizeof(double));
static_assert(offsetof(Particle, mass_damping) == 8 * sizeof(double));
static_assert(offsetof(Particle, stiffness_damping) == 9 * sizeof(double));
static_assert(offsetof(Particle, joint) == 10 * sizeof(double));
static_assert(offsetof(Joint, on_self) == 3 * sizeof(double));
static_assert(offsetof(Joint, rest) == 6 * sizeof(double));
static_assert(offsetof(Joint, shear_stiffness) == 10 * sizeof(double));
static_assert(offsetof(Joint, bend_stiffness) == 13 * sizeof(double));
static_assert(offsetof(Joint, rest_force) == 16 * sizeof(double));
static_assert(offsetof(Joint, rest_moment) == 19 * sizeof(double));
static_assert(sizeof(Motion) == lanes::kMotionStride * sizeof(double));
static_assert(offsetof(Motion, orientation) == 4 * sizeof(double));
static_assert(offsetof(Motion, velocity) == 8 * sizeof(double));
static_assert(offsetof(Motion, angular_velocity) == 11 * sizeof(double));
static_assert(offsetof(Motion, acceleration) == 14 * sizeof(double));
static_assert(offsetof(Motion, angular_acceleration) == 17 * sizeof(double));

// Packs whose joints are looked at before they are eliminated: their records fit the first-level cache.
constexpr size_t kPacksAtOnce = 8;

const double* numbers(const void* structures) {
  return static_cast<const double*>(structures);
}

}  // namespace

// Balanced at t + (1−α_f) h, with x_f = x̂ + k₁ a₁, v_f = v̂ + k₂ a₁ (x̂, v̂ the prediction with a₁ = 0):
//   [ (1−α_m) M + k₂ D + k₁ K ] a₁ = F − α_m M a₀ − D v̂ − f(x̂),   k₁ = (1−α_f) β h²,   k₂ = (1−α_f) γ h
struct PlantStepper::Substep {
  double h;
  GeneralizedAlpha method;
  std::span<const Wrench> external;
  std::span<const WorldSpring> transient;
  Vec3 gravity;
  double position_rate = (1 - method.alpha_f) * method.beta * h * h;  // k₁, s²
  double velocity_rate = (1 - method.alpha_f) * method.gamma * h;     // k₂, s
};

StepReport PlantStepper::step(Plant& plant, std::span<const Wrench> external,
                              std::span<const WorldSpring> transient, const StepOptions& options) noexcept {
  prepare(plant);
  StepReport report;
  report.calibrated = options.dt == plant.scheme.dt;

  for (int finer = 1;; finer *= 2) {
    const bool last = 2 * finer > options.most_redo_substeps;
    const int parts = plant.scheme.substeps * finer;
    const Substep part{options.dt / parts, GeneralizedAlpha(finer == 1 ? plant.scheme.rho_infinity : 0),
                       external, transient, options.gravity};
    report.gap = 0;
    report.finite = true;
    for (int i = 0; i < parts && report.finite && (last || report.gap <= options.gap_limit); ++i) {
      report.finite = substep(plant, part, i == 0 ? plant.motion : now_, next_, report.gap);
      now_.swap(next_);
      ++report.solves;
    }
    report.gap_held = report.gap <= options.gap_limit;
    if ((report.finite && report.gap_held) || last) break;
    ++report.redone;
  }

  if (report.finite) {
    plant.motion.swap(now_);
  } else {
    for (Motion& m : plant.motion) m = {.position = m.position, .orientation = m.orientation};
  }
  return report;
}

bool PlantStepper::substep(const Plant& plant, const Substep& step, const std::vector<Motion>& from,
                           std::vector<Motion>& to, double& gap) noexcept {
  const auto count = static_cast<uint32_t>(plant.particles.size());
  const std::span<const lanes::Pack> packs = order_.packs();
  const auto& [alpha_m, alpha_f, gamma, beta] = step.method;
  const lanes::StepView view{
      .count = count,
      .particle = numbers(plant.particles.data()),
      .from = numbers(from.data()),
      .to = static_cast<double*>(static_cast<void*>(to.data())),
      .pose = pose_.data(),
      .block = block_.data(),
      .record = record_.data(),
      .packs = packs.data(),
      .gravity = {step.gravity.x(), step.gravity.y(), step.gravity.z()},
      .h = step.h,
      .alpha_m = alpha_m,
      .alpha_f = alpha_f,
      .gamma = gamma,
      .beta = beta,
      .position_rate = step.position_rate,
      .velocity_rate = step.velocity_rate,
  };
  kernels_->predict(view, 0, count);
  for (size_t i = 0; i < std::min<size_t>(count, step.external.size()); ++i) {
    Eigen::Map<Vec6> load(&block_[lanes::kBlockStride * i + lanes::kBlockLoad]);
    load.head<3>() += step.external[i].force;
    load.tail<3>() += step.external[i].torque;
  }
  add_springs(plant.anchors, step);
  add_springs(step.transient, step);
  for (size_t i = 0; i < packs.size(); i += kPacksAtOnce) {
    const size_t end = std::min(i + kPacksAtOnce, packs.size());
    kernels_->assemble(view, i, end);
    kernels_->factor(view, i, end);
  }
  const lanes::AdvanceResult result = kernels_->advance(view, 0, packs.size());
  gap = std::max(gap, result.gap);
  return result.finite;
}

void PlantStepper::add_springs(std::span<const WorldSpring> springs, const Substep& step) noexcept {
  using Row = Eigen::Map<const Vec3>;
  for (const WorldSpring& spring : springs) {
    const size_t i = spring.particle.index();
    const double* pose = &pose_[lanes::kPoseStride * i];
    const Vec3 lever = Eigen::Map<const Quat>(pose + 4) * spring.on_particle;
    const Vec3 slip = Row(pose + 8) + Row(pose + 11).cross(lever) - spring.target_velocity;
    const Vec3 force = -spring.stiffness * (Row(pose) + lever - spring.target) - spring.damping * slip;
    const Mat3 S = step.position_rate * spring.stiffness + step.velocity_rate * spring.damping;
    const Mat3 L = skew(lever), Q = L * S, R = Q * L.transpose();
    double* block = &block_[lanes::kBlockStride * i];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column <= row; ++column) *block++ += S(row, column);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) *block++ += Q(row, column);
      for (int column = 0; column <= row; ++column) *block++ += R(row, column);
    }
    for (int row = 0; row < 3; ++row) *block++ += force[row];
    const Vec3 torque = lever.cross(force);
    for (int row = 0; row < 3; ++row) *block++ += torque[row];
  }
}

void PlantStepper::prepare(const Plant& plant) {
  if (!order_.update(plant.particles)) return;
  const size_t count = plant.particles.size();
  pose_.assign(lanes::kPoseStride * (count + 1), 0);
  pose_[lanes::kPoseStride * count + 7] = 1;  // the world: identity, at rest
  block_.assign(lanes::kBlockStride * (count + 1), 0);
  record_.resize(4 * lanes::kRecordLanes * order_.packs().size());
  now_.resize(count);
  next_.resize(count);
}

}  // namespace liana
