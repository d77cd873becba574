#include "runtime/sim/step/time_step.h"

#include <array>
#include <atomic>
#include <cstddef>

#include "mesher/base/parallel.h"
#include "runtime/sim/model/large_pages.h"
#include "runtime/sim/step/free_flight.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"
#include "runtime/sim/step/reseat.h"

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

// Gaps that open no faster than that in a step, up to that much, are a soft stem's answer to a steady pull.
constexpr double kSlowly = 4e-3, kMostStretch = 0.2;

// Packs whose joints are looked at before they are eliminated: their records fit the first-level cache.
constexpr size_t kPacksAtOnce = 8;

const double* numbers(const void* structures) {
  return static_cast<const double*>(structures);
}

// What a substep computes with and then forgets. A thread keeps its own: while plants are stepped one after
// the other, they stay in the cache. Threads that share a plant use one each of those of the calling thread.
struct Workspace {
  std::vector<double> pose, block;                 // see step_view.h
  std::vector<double, LargePages<double>> record;  // of the first one only

  static void grow(auto& numbers, size_t size) {
    if (numbers.size() < size) numbers.resize(size);
  }
  // stale: the parts that will be eliminated; empty for all.
  void prepare(const EliminationOrder& order, const Vec3& world_position, std::span<const uint8_t> stale) {
    grow(pose, size_t{lanes::kPoseStride} * order.pose_slots());
    grow(block, size_t{lanes::kBlockStride} * order.block_slots());
    // The world: unturned, at rest. What it is handed is not looked at.
    double* world = &pose[size_t{lanes::kPoseStride} * order.world_slot()];
    std::fill_n(world, lanes::kPoseStride, 0.0);
    Eigen::Map<Vec3>{world} = world_position;
    world[7] = 1;
    std::fill_n(block_of(order.world_slot()), lanes::kBlockStride, 0.0);
    for (size_t part = 0; part < order.parts().size(); ++part) {
      if (!stale.empty() && !stale[part]) continue;
      for (const EliminationOrder::Handover& h : order.handovers_of(part, part + 1))
        std::fill_n(block_of(h.from), lanes::kBlockStride, 0.0);
    }
  }
  double* block_of(uint32_t slot) { return &block[size_t{lanes::kBlockStride} * slot]; }
  void copy_top_poses(const Workspace& from, const EliminationOrder& order) {
    std::copy_n(from.pose.data(), size_t{lanes::kPoseStride} * order.world_slot(), pose.data());
  }
};
constexpr unsigned kMostShares = 16;
thread_local std::array<Workspace, kMostShares> workspaces;
// The step whose records and handovers they hold, when all of it was one elimination.
thread_local uint64_t held_step = 0;
std::atomic<uint64_t> last_step{0};

// Calls work(share) for each, on as many threads.
template <class Work>
void in_shares(unsigned shares, const Work& work) {
  if (shares == 1) return work(0u);
  parallel_for(shares, shares, [&work](size_t share, unsigned) { work(static_cast<unsigned>(share)); });
}

// How far the plant's first particle is from where the world holds it.
Vec3 off_support(const Plant& plant) {
  if (plant.particles.empty() || plant.particles[0].joint.shear_stiffness.isZero(0)) return Vec3::Zero();
  const Motion& m = plant.motion[0];
  const Joint& joint = plant.particles[0].joint;
  return m.position + m.orientation * joint.on_self - joint.on_parent;
}

// What a step is redone with: generalized-α at ρ∞ = 0, at last backward Euler.
GeneralizedAlpha method_of(const TimeScheme& scheme, int finer, int finest) {
  if (finer == 1) return GeneralizedAlpha(scheme.rho_infinity);
  return 4 * finer > finest ? GeneralizedAlpha::backward_euler() : GeneralizedAlpha(0);
}

// The same resistance in all directions, at the centre: wind, mostly.
bool is_drag(const WorldSpring& spring) {
  const Mat3& d = spring.damping;
  return spring.stiffness.isZero(0) && spring.on_particle.isZero(0) && d(1, 1) == d(0, 0) &&
         d(2, 2) == d(0, 0) && d(0, 1) == 0 && d(0, 2) == 0 && d(1, 0) == 0 && d(1, 2) == 0 && d(2, 0) == 0 &&
         d(2, 1) == 0;
}

// A spring's force and stiffness into the block of its particle.
void add_spring(const WorldSpring& spring, double position_rate, double velocity_rate, const double* pose,
                double* block) {
  using Row = Eigen::Map<const Vec3>;
  if (is_drag(spring)) {
    const double damping = spring.damping(0, 0);
    const Vec3 force = damping * (spring.target_velocity - Row(pose + 8));
    for (const int diagonal : {0, 2, 5}) block[diagonal] += velocity_rate * damping;
    for (int row = 0; row < 3; ++row) block[lanes::kBlockLoad + row] += force[row];
    return;
  }
  const Vec3 lever = Eigen::Map<const Quat>(pose + 4) * spring.on_particle;
  const Vec3 slip = Row(pose + 8) + Row(pose + 11).cross(lever) - spring.target_velocity;
  const Vec3 force = -spring.stiffness * (Row(pose) + lever - spring.target) - spring.damping * slip;
  const Mat3 S = position_rate * spring.stiffness + velocity_rate * spring.damping;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column <= row; ++column) *block++ += S(row, column);
  if (spring.on_particle.isZero(0)) {  // at the centre it turns nothing
    for (int row = 0; row < 3; ++row) block[15 + row] += force[row];
    return;
  }
  const Mat3 L = skew(lever), Q = L * S, R = Q * L.transpose();  // T(r)ᵀ [S 0; 0 0] T(r)
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) *block++ += Q(row, column);
    for (int column = 0; column <= row; ++column) *block++ += R(row, column);
  }
  const Vec3 torque = lever.cross(force);
  for (int row = 0; row < 3; ++row) *block++ += force[row];
  for (int row = 0; row < 3; ++row) *block++ += torque[row];
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
  unsigned threads;
  Vec3 world = Vec3::Zero();                                          // how far the world is off its place
  double position_rate = (1 - method.alpha_f) * method.beta * h * h;  // k₁, s²
  double velocity_rate = (1 - method.alpha_f) * method.gamma * h;     // k₂, s

  lanes::StepView view(const Plant& plant, const std::vector<Motion>& from, std::vector<Motion>& to,
                       const EliminationOrder& order, Workspace& space) const {
    return {
        .particle = numbers(plant.particles.data()),
        .from = numbers(from.data()),
        .to = static_cast<double*>(static_cast<void*>(to.data())),
        .pose = space.pose.data(),
        .block = space.block.data(),
        .record = space.record.data(),
        .packs = order.packs().data(),
        .pack_count = order.packs().size(),
        .gravity = {gravity.x(), gravity.y(), gravity.z()},
        .h = h,
        .alpha_m = method.alpha_m,
        .alpha_f = method.alpha_f,
        .before = method.before,
        .after = method.beta,
        .gamma = method.gamma,
        .position_rate = position_rate,
        .velocity_rate = velocity_rate,
    };
  }
};

StepReport PlantStepper::step_from(Plant& plant, std::span<const Wrench> external,
                                   std::span<const WorldSpring> transient, size_t known,
                                   const StepOptions& options) noexcept {
  if (plant.scheme.solver == Solver::ShapeMatching) {
    next_ = plant.motion;
    return shape_matching_.step(plant, external, transient, options);
  }
  const size_t count = plant.particles.size();
  const bool some = known > 0 && kept_ > 0 && kept_ == held_step && order_.particles() == count;
  kept_ = held_step = 0;
  order_.update(plant.particles, false);
  now_.resize(count);
  next_.resize(count);
  sort_springs(plant, transient);
  stale_.assign(order_.parts().size(), 0);
  for (const WorldSpring& spring :
       transient.subspan(some ? std::min(known, transient.size()) : transient.size()))
    if (const uint32_t part = order_.part_of(spring.particle); part < stale_.size()) stale_[part] = 1;
  StepReport report;
  // A support that jumped is carried to its new place within the step, when the step has to be redone.
  const Vec3 teleported = off_support(plant);
  start_gap_ = gap_;
  const double gap_limit = std::max(options.gap_limit, std::min(start_gap_ + kSlowly, kMostStretch));
  report.calibrated = options.dt == plant.scheme.dt;

  for (int finer = 1;; finer *= 2) {
    const bool last = 2 * finer > options.most_redo_substeps;
    const int parts = plant.scheme.substeps * finer;
    Substep part{options.dt / parts, method_of(plant.scheme, finer, options.most_redo_substeps),
                 external,           transient,
                 options.gravity,    options.threads};
    report.gap = 0;
    report.finite = true;
    for (int i = 0; i < parts && report.finite && (last || report.gap <= gap_limit); ++i) {
      if (i > 0) now_.swap(next_);
      const std::vector<Motion>& from = i == 0 ? plant.motion : now_;
      if (finer > 1) part.world = (1 - (i + 1.0) / parts) * teleported;
      Outcome outcome = substep(plant, part, from, next_, some && report.solves == 0, report.gap);
      if (outcome == Outcome::TreeChanged) {
        order_.update(plant.particles, true);
        sort_springs(plant, transient);
        outcome = substep(plant, part, from, next_, false, report.gap);
      }
      report.finite = outcome == Outcome::Finite;
      ++report.solves;
    }
    report.gap_held = report.gap <= gap_limit;
    if ((report.finite && report.gap_held) || last) break;
    ++report.redone;
  }

  if (report.solves == 1 && report.finite) kept_ = held_step = ++last_step;
  if (report.finite) {
    plant.motion.swap(next_);
    if (!report.gap_held && options.most_redo_substeps > 1)
      report.reseated = reseat(plant, next_, options.gap_limit);
    gap_ = report.reseated > 0 ? options.gap_limit : report.gap;
    if (plant.anchors.empty() && transient.empty() && external.empty()) keep_angular_momentum(next_, plant);
  } else {
    next_ = plant.motion;
    for (Motion& m : plant.motion) m = {.position = m.position, .orientation = m.orientation};
  }
  return report;
}

PlantStepper::Outcome PlantStepper::substep(const Plant& plant, const Substep& step,
                                            const std::vector<Motion>& from, std::vector<Motion>& to,
                                            bool some, double& gap) noexcept {
  const std::span<const EliminationOrder::Part> parts = order_.parts();
  const EliminationOrder::Part top = order_.top();
  const unsigned shares = parts.empty() ? 1 : std::clamp(step.threads, 1u, kMostShares);
  const std::span<Workspace> spaces(workspaces.data(), shares);  // of this thread, whoever uses them
  const std::span<const uint8_t> stale = some ? std::span<const uint8_t>(stale_) : std::span<const uint8_t>();
  for (Workspace& space : spaces) space.prepare(order_, step.world, stale);
  Workspace& main = spaces[0];
  Workspace::grow(main.record, size_t{4 * lanes::kRecordLanes} * order_.packs().size());
  const lanes::StepView view = step.view(plant, from, to, order_, main);
  const auto eliminate = [&](lanes::StepView view, const EliminationOrder::Part& part) {
    view.ahead = part.last - part.first;  // to the next part
    for (size_t i = part.first; i < part.last; i += kPacksAtOnce) {
      const size_t end = std::min<size_t>(i + kPacksAtOnce, part.last);
      kernels_->assemble(view, i, end);
      kernels_->factor(view, i, end);
    }
  };
  const auto view_of = [&](unsigned share) {
    lanes::StepView own = view;
    own.pose = spaces[share].pose.data();
    own.block = spaces[share].block.data();
    if (share > 0) spaces[share].copy_top_poses(main, order_);
    return own;
  };
  const auto first_of = [&](unsigned share) { return static_cast<uint32_t>(parts.size() * share / shares); };

  // Leaves to root: poses at the moment of balance, loads, joints, every particle out of the system.
  kernels_->predict(view, top.first, top.last);
  if (!order_.still_holds(plant.particles, top)) return Outcome::TreeChanged;
  add_loads(step, top, static_cast<uint32_t>(parts.size()), view);
  std::array<bool, kMostShares> holds{};
  in_shares(shares, [&](unsigned share) {
    const lanes::StepView own = view_of(share);
    for (uint32_t k = first_of(share); k < first_of(share + 1); ++k) {
      if (some && !stale[k]) continue;
      kernels_->predict(own, parts[k].first, parts[k].last);
      if (!order_.still_holds(plant.particles, parts[k])) return;
      add_loads(step, parts[k], k, own);
      eliminate(own, parts[k]);
    }
    holds[share] = true;
  });
  for (unsigned share = 0; share < shares; ++share)
    if (!holds[share]) return Outcome::TreeChanged;
  for (unsigned share = 0; share < shares; ++share)
    for (const EliminationOrder::Handover& h : order_.handovers_of(first_of(share), first_of(share + 1)))
      for (int i = 0; i < lanes::kBlockStride; ++i)
        main.block_of(h.to)[i] += spaces[share].block_of(h.from)[i];
  eliminate(view, top);

  // Root to leaves: accelerations and the new state. What was met last is in the cache still.
  std::array<lanes::AdvanceResult, kMostShares> results{};
  lanes::AdvanceResult result = kernels_->advance(view, top.first, top.last);
  in_shares(shares, [&](unsigned share) {
    const lanes::StepView own = view_of(share);
    for (uint32_t k = first_of(share + 1); k-- > first_of(share);)
      results[share].add(kernels_->advance(own, parts[k].first, parts[k].last));
  });
  for (const lanes::AdvanceResult& more : results) result.add(more);
  gap = std::max(gap, result.gap);
  return result.finite ? Outcome::Finite : Outcome::NotFinite;
}

void PlantStepper::add_loads(const Substep& step, const EliminationOrder::Part& part, uint32_t number,
                             const lanes::StepView& view) noexcept {
  if (!step.external.empty()) {
    for (uint32_t p = part.first; p < part.last; ++p) {
      const lanes::Pack& pack = order_.packs()[p];
      for (uint32_t k = 0; k < pack.count; ++k) {
        if (pack.self[k] >= step.external.size()) continue;
        Eigen::Map<Vec6> load(view.block + size_t{lanes::kBlockStride} * pack.slot[k] + lanes::kBlockLoad);
        load.head<3>() += step.external[pack.self[k]].force;
        load.tail<3>() += step.external[pack.self[k]].torque;
      }
    }
  }
  constexpr uint32_t kAhead = 4;
  for (uint32_t i = first_spring_[number]; i < first_spring_[number + 1]; ++i) {
    if (i + kAhead < springs_.size()) {
      const char* next = reinterpret_cast<const char*>(springs_[i + kAhead]);
      for (size_t line = 0; line < sizeof(WorldSpring); line += 64) __builtin_prefetch(next + line);
    }
    const uint32_t slot = order_.slot_of(springs_[i]->particle);
    add_spring(*springs_[i], step.position_rate, step.velocity_rate,
               view.pose + size_t{lanes::kPoseStride} * slot,
               view.block + size_t{lanes::kBlockStride} * slot);
  }
}

// In the order given, part by part.
void PlantStepper::sort_springs(const Plant& plant, std::span<const WorldSpring> transient) noexcept {
  const std::span<const WorldSpring> lists[] = {plant.anchors, transient};
  first_spring_.assign(order_.parts().size() + 2, 0);
  for (const auto& list : lists)
    for (const WorldSpring& spring : list) ++first_spring_[order_.part_of(spring.particle) + 1];
  for (size_t k = 1; k < first_spring_.size(); ++k) first_spring_[k] += first_spring_[k - 1];
  springs_.resize(first_spring_.back());
  for (const auto& list : lists)
    for (const WorldSpring& spring : list)
      springs_[first_spring_[order_.part_of(spring.particle)]++] = &spring;
  for (size_t k = first_spring_.size() - 1; k > 0; --k) first_spring_[k] = first_spring_[k - 1];
  first_spring_[0] = 0;
}

}  // namespace liana
