#include "runtime/sim/step/substep.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "mesher/base/parallel.h"
#include "runtime/sim/step/joints.h"
#include "runtime/sim/step/spring_load.h"

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

/// The supernodes of one plant, divided among threads: each share has its own poses and blocks, all have the
/// records of the first.
class SubstepSolver::Shares {
 public:
  Shares(const Plant& plant, const Substep& step, std::span<const Motion> from, std::span<Motion> to,
         const EliminationOrder& order, std::span<const uint8_t> stale, StepWorkspace& workspace)
      : step_(step),
        stale_(step.only_stale ? stale : std::span<const uint8_t>()),
        supernodes_(order.supernodes()),
        order_(order),
        count_(supernodes_.empty() ? 1 : std::clamp(step.threads, 1u, StepWorkspace::kMostShares)) {
    workspace.fit(order, count_);
    spaces_ = workspace.spaces(count_);
    for (StepWorkspace::Space& space : spaces_) space.prepare(order, step.world, stale_);
    view_ = {
        .particle = numbers(plant.particles.data()),
        .from = numbers(from.data()),
        .to = static_cast<double*>(static_cast<void*>(to.data())),
        .pose = spaces_[0].pose.data(),
        .block = spaces_[0].block.data(),
        .record = workspace.record(),
        .packs = order.packs().data(),
        .pack_count = order.packs().size(),
        .gravity = {step.gravity.x(), step.gravity.y(), step.gravity.z()},
        .h = step.h,
        .alpha_m = step.method.alpha_m,
        .alpha_f = step.method.alpha_f,
        .before = step.method.before,
        .after = step.method.beta,
        .gamma = step.method.gamma,
        .position_rate = step.position_rate,
        .velocity_rate = step.velocity_rate,
    };
  }

  const Substep& step() const { return step_; }
  const lanes::StepView& view() const { return view_; }
  unsigned count() const { return count_; }
  uint32_t first_of(unsigned share) const {
    return static_cast<uint32_t>(supernodes_.size() * share / count_);
  }
  bool is_done(uint32_t supernode) const { return !stale_.empty() && !stale_[supernode]; }

  /// Calls work(share, view) for each, on as many threads as there are to have.
  template <class Work>
  void each(const Work& work) const {
    if (count_ == 1) return work(0u, view_);
    parallel_for(count_, count_, [&](size_t i, unsigned) {
      const auto share = static_cast<unsigned>(i);
      lanes::StepView own = view_;
      own.pose = spaces_[share].pose.data();
      own.block = spaces_[share].block.data();
      if (share > 0) spaces_[share].copy_top_poses(spaces_[0], order_);
      work(share, own);
    });
  }

  /// What the supernodes hand on, added to the top in their order.
  void extend_add() const {
    for (unsigned share = 0; share < count_; ++share)
      for (const auto& [from, to] : order_.extend_adds_of(first_of(share), first_of(share + 1)))
        for (int i = 0; i < lanes::kBlockStride; ++i)
          spaces_[0].block_of(to)[i] += spaces_[share].block_of(from)[i];
  }

 private:
  const Substep& step_;
  std::span<const uint8_t> stale_;
  std::span<const EliminationOrder::Supernode> supernodes_;
  const EliminationOrder& order_;
  unsigned count_;
  std::span<StepWorkspace::Space> spaces_;
  lanes::StepView view_;
};

SubstepOutcome SubstepSolver::take(const Plant& plant, const Substep& step, std::span<const Motion> from,
                                   std::span<Motion> to, StepWorkspace& workspace) {
  const Shares shares(plant, step, from, to, order_, stale_, workspace);
  if (!leaves_to_root(plant, shares)) return {.tree_changed = true};
  return root_to_leaves(shares);
}

// Poses at the moment of balance, loads, joints, every particle out of the system. False: another tree.
bool SubstepSolver::leaves_to_root(const Plant& plant, const Shares& shares) {
  const std::span<const EliminationOrder::Supernode> supernodes = order_.supernodes();
  const EliminationOrder::Supernode top = order_.top();
  kernels_->predict(shares.view(), top.first, top.last);
  if (!order_.still_holds(plant.particles, top)) return false;
  add_loads(shares.step(), top, static_cast<uint32_t>(supernodes.size()), shares.view());
  std::array<bool, StepWorkspace::kMostShares> holds{};
  shares.each([&](unsigned share, const lanes::StepView& view) {
    for (uint32_t k = shares.first_of(share); k < shares.first_of(share + 1); ++k) {
      if (shares.is_done(k)) continue;
      kernels_->predict(view, supernodes[k].first, supernodes[k].last);
      if (!order_.still_holds(plant.particles, supernodes[k])) return;
      add_loads(shares.step(), supernodes[k], k, view);
      eliminate(view, supernodes[k]);
    }
    holds[share] = true;
  });
  for (unsigned share = 0; share < shares.count(); ++share)
    if (!holds[share]) return false;
  shares.extend_add();
  eliminate(shares.view(), top);
  return true;
}

void SubstepSolver::eliminate(lanes::StepView view, const EliminationOrder::Supernode& those) const {
  view.ahead = those.last - those.first;  // to the next supernode
  for (size_t i = those.first; i < those.last; i += kPacksAtOnce) {
    const size_t end = std::min<size_t>(i + kPacksAtOnce, those.last);
    kernels_->assemble(view, i, end);
    kernels_->factor(view, i, end);
  }
}

// Accelerations and the new state. What was met last is in the cache still.
SubstepOutcome SubstepSolver::root_to_leaves(const Shares& shares) {
  const std::span<const EliminationOrder::Supernode> supernodes = order_.supernodes();
  std::array<lanes::AdvanceResult, StepWorkspace::kMostShares> results{};
  lanes::AdvanceResult result = kernels_->advance(shares.view(), order_.top().first, order_.top().last);
  shares.each([&](unsigned share, const lanes::StepView& view) {
    for (uint32_t k = shares.first_of(share + 1); k-- > shares.first_of(share);)
      results[share].add(kernels_->advance(view, supernodes[k].first, supernodes[k].last));
  });
  for (const lanes::AdvanceResult& more : results) result.add(more);
  return {.gap = result.gap, .finite = result.finite};
}

void SubstepSolver::add_loads(const Substep& step, const EliminationOrder::Supernode& those, uint32_t number,
                              const lanes::StepView& view) const {
  if (!step.external.empty()) {
    for (uint32_t p = those.first; p < those.last; ++p) {
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

// Springs in the order given, supernode by supernode.
void SubstepSolver::prepare(const Plant& plant, std::span<const WorldSpring> transient, bool changed) {
  order_.update(plant.particles, changed);
  const std::span<const WorldSpring> lists[] = {plant.anchors, transient};
  first_spring_.assign(order_.supernodes().size() + 2, 0);
  for (const auto& list : lists)
    for (const WorldSpring& spring : list) ++first_spring_[order_.supernode_of(spring.particle) + 1];
  for (size_t k = 1; k < first_spring_.size(); ++k) first_spring_[k] += first_spring_[k - 1];
  // Room for as many as there usually are at most: wind, and contacts at every other particle.
  if (springs_.capacity() < first_spring_.back())
    springs_.reserve(std::max<size_t>(2 * first_spring_.back(), 2 * plant.particles.size()));
  springs_.resize(first_spring_.back());
  for (const auto& list : lists)
    for (const WorldSpring& spring : list)
      springs_[first_spring_[order_.supernode_of(spring.particle)]++] = &spring;
  for (size_t k = first_spring_.size() - 1; k > 0; --k) first_spring_[k] = first_spring_[k - 1];
  first_spring_[0] = 0;
}

void SubstepSolver::mark_stale(std::span<const WorldSpring> transient, size_t known) {
  stale_.assign(order_.supernodes().size(), 0);
  for (const WorldSpring& spring : transient.subspan(std::min(known, transient.size())))
    if (const uint32_t supernode = order_.supernode_of(spring.particle); supernode < stale_.size())
      stale_[supernode] = 1;
}

}  // namespace liana
