#include "runtime/sim/step/step_workspace.h"

#include <algorithm>
#include <atomic>

namespace liana {
namespace {

void grow(auto& numbers, size_t size) {
  if (numbers.size() < size) numbers.resize(size);
}

}  // namespace

void StepWorkspace::Space::prepare(const EliminationOrder& order, const Vec3& world_position,
                                   std::span<const uint8_t> stale) {
  grow(pose, size_t{lanes::kPoseStride} * order.pose_slots());
  grow(block, size_t{lanes::kBlockStride} * order.block_slots());
  // What the world is handed is not looked at.
  double* world = &pose[size_t{lanes::kPoseStride} * order.world_slot()];
  std::fill_n(world, lanes::kPoseStride, 0.0);
  Eigen::Map<Vec3>{world} = world_position;
  world[7] = 1;
  std::fill_n(block_of(order.world_slot()), lanes::kBlockStride, 0.0);
  for (size_t k = 0; k < order.supernodes().size(); ++k) {
    if (!stale.empty() && !stale[k]) continue;
    for (const EliminationOrder::ExtendAdd& h : order.extend_adds_of(k, k + 1))
      std::fill_n(block_of(h.from), lanes::kBlockStride, 0.0);
  }
}

void StepWorkspace::Space::copy_top_poses(const Space& from, const EliminationOrder& order) {
  std::copy_n(from.pose.data(), size_t{lanes::kPoseStride} * order.world_slot(), pose.data());
}

void StepWorkspace::fit(const EliminationOrder& order, unsigned shares) {
  grow(spaces_, shares);
  grow(record_, size_t{4 * lanes::kRecordLanes} * order.packs().size());
}

void StepWorkspace::level(std::span<StepWorkspace> workspaces) {
  size_t spaces = 0, record = 0, pose = 0, block = 0;
  for (const StepWorkspace& one : workspaces) {
    spaces = std::max(spaces, one.spaces_.size());
    record = std::max(record, one.record_.size());
    for (const Space& space : one.spaces_) {
      pose = std::max(pose, space.pose.size());
      block = std::max(block, space.block.size());
    }
  }
  for (StepWorkspace& one : workspaces) {
    grow(one.spaces_, spaces);
    grow(one.record_, record);
    for (Space& space : one.spaces_) grow(space.pose, pose), grow(space.block, block);
  }
}

uint64_t StepWorkspace::hold() {
  static std::atomic<uint64_t> last{0};
  return held_ = ++last;
}

}  // namespace liana
