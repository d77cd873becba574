#include "runtime/sim/step/elimination_order.h"

#include <algorithm>

namespace liana {
namespace {

constexpr uint32_t kNone = ParticleId::kNone;
// A particle takes 1.4 kB on the way up (itself, its motion, pose, block and record), one of the next
// supernode 0.4 kB: two thirds of a second-level cache of a megabyte. Subtrees are small beside a supernode,
// so that supernodes fill.
constexpr uint32_t kLargestSupernode = 384, kLargestSubtree = 128;

}  // namespace

void EliminationOrder::update(std::span<const Particle> particles, bool changed) {
  const auto count = static_cast<uint32_t>(particles.size());
  if (parent_.size() == count && !changed) return;
  parent_.resize(count);
  for (uint32_t i = 0; i < count; ++i)
    parent_[i] = particles[i].parent.valid() ? particles[i].parent.value : count;
  divide();
}

bool EliminationOrder::still_holds(std::span<const Particle> particles, Supernode those) const {
  const auto count = static_cast<uint32_t>(parent_.size());
  bool holds = true;
  for (uint32_t p = those.first; p < those.last; ++p) {
    for (const uint32_t i : packs_[p].self) {
      const ParticleId parent = particles[i].parent;
      holds &= (parent.valid() ? parent.value : count) == parent_[i];
    }
  }
  return holds;
}

void EliminationOrder::divide() {
  measure_tree();
  const uint32_t supernodes = group_subtrees();
  const uint32_t widest = sort_members(supernodes);
  world_slot_ = slot_[parent_.size()] = start_[supernodes + 1] - start_[supernodes];
  pose_slots_ = block_slots_ = world_slot_ + 1 + widest;
  packs_.clear();
  supernodes_.clear();
  extend_adds_.clear();
  const auto members = [&](uint32_t k) {
    return std::span(members_).subspan(start_[k], start_[k + 1] - start_[k]);
  };
  top_ = pack(members(supernodes));
  const std::vector<lanes::Pack> top(packs_.begin(), packs_.end());
  packs_.clear();
  for (uint32_t k = 0; k < supernodes; ++k) supernodes_.push_back(pack(members(k)));
  top_.first = static_cast<uint32_t>(packs_.size());
  top_.last = static_cast<uint32_t>(packs_.size() + top.size());
  packs_.insert(packs_.end(), top.begin(), top.end());
}

// Depths, sizes of subtrees, and empty queues per depth.
void EliminationOrder::measure_tree() {
  const auto count = static_cast<uint32_t>(parent_.size());
  depth_.resize(count);
  size_.assign(count + 1, 0);
  supernode_.resize(count);
  slot_.assign(count + 1, 0);
  next_.assign(count, kNone);
  younger_.assign(count, kNone);
  youngest_.assign(count, kNone);
  waiting_.assign(count + 1, 0);
  uint32_t deepest = 0;
  for (uint32_t i = 0; i < count; ++i) {
    depth_[i] = parent_[i] == count ? 0 : depth_[parent_[i]] + 1;
    deepest = std::max(deepest, depth_[i]);
  }
  for (uint32_t i = count; i-- > 0;) size_[parent_[i]] += ++size_[i];
  first_.assign(deepest + 1, kNone);
  last_.assign(deepest + 1, kNone);
}

// Which supernode every particle belongs to; the top is the last. Returns how many there are below it.
uint32_t EliminationOrder::group_subtrees() {
  const auto count = static_cast<uint32_t>(parent_.size());
  const uint32_t largest_subtree = count <= kLargestSupernode ? 0 : kLargestSubtree;
  uint32_t supernodes = 0, filled = kLargestSupernode;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t p = parent_[i];
    if (size_[i] > largest_subtree) {
      supernode_[i] = kNone;
    } else if (p != count && supernode_[p] != kNone) {
      supernode_[i] = supernode_[p];
    } else {
      if (filled + size_[i] > kLargestSupernode) ++supernodes, filled = 0;
      filled += size_[i];
      supernode_[i] = supernodes - 1;
    }
  }
  for (uint32_t& supernode : supernode_) supernode = std::min(supernode, supernodes);
  return supernodes;
}

// A counting sort by supernode. Returns how many particles the largest below the top has.
uint32_t EliminationOrder::sort_members(uint32_t supernodes) {
  start_.assign(supernodes + 2, 0);
  for (const uint32_t supernode : supernode_) ++start_[supernode + 1];
  uint32_t widest = 0;
  for (uint32_t k = 0; k <= supernodes; ++k) {
    if (k < supernodes) widest = std::max(widest, start_[k + 1]);
    start_[k + 1] += start_[k];
  }
  members_.resize(parent_.size());
  for (uint32_t i = 0; i < members_.size(); ++i) members_[start_[supernode_[i]]++] = i;
  for (uint32_t k = supernodes + 1; k > 0; --k) start_[k] = start_[k - 1];
  start_[0] = 0;
  return widest;
}

// A particle waits for its children, and for the sibling before it: small subtrees first, as when they are in
// supernodes of their own; else in the order of the arrays.
void EliminationOrder::find_what_waits(std::span<const uint32_t> members) {
  const uint32_t own = supernode_[members[0]];
  const auto inside = [&](uint32_t i) { return i != parent_.size() && supernode_[i] == own; };
  for (const bool small : {true, false}) {
    for (const uint32_t i : members) {
      if (!inside(parent_[i]) || (size_[i] <= kLargestSubtree) != small) continue;
      ++waiting_[parent_[i]];
      uint32_t& last = youngest_[parent_[i]];
      if (last != kNone) younger_[last] = i, ++waiting_[i];
      last = i;
    }
  }
}

EliminationOrder::Supernode EliminationOrder::pack(std::span<const uint32_t> members) {
  const auto count = static_cast<uint32_t>(parent_.size()), first_pack = static_cast<uint32_t>(packs_.size()),
             first_extend_add = static_cast<uint32_t>(extend_adds_.size());
  if (members.empty()) return {first_pack, first_pack, first_extend_add};
  const uint32_t own = supernode_[members[0]];
  const bool is_top = own + 2 == start_.size();
  const auto inside = [&](uint32_t i) { return i != count && supernode_[i] == own; };
  const auto ready = [&](uint32_t i) {
    uint32_t& last = last_[depth_[i]];
    (last == kNone ? first_[depth_[i]] : next_[last]) = i;
    last = i;
  };
  find_what_waits(members);
  uint32_t top = 0, bottom = depth_[members[0]], slot = is_top ? 0 : world_slot_ + 1;
  for (const uint32_t i : members) {
    bottom = std::min(bottom, depth_[i]);
    if (waiting_[i] > 0) continue;
    ready(i);
    top = std::max(top, depth_[i]);
  }
  for (size_t done = 0; done < members.size();) {
    lanes::Pack pack{};
    for (uint32_t depth = top + 1; depth-- > bottom && pack.count < 4;) {
      while (pack.count < 4 && first_[depth] != kNone) {
        const uint32_t i = first_[depth];
        first_[depth] = next_[i];
        if (first_[depth] == kNone) last_[depth] = kNone;
        slot_[i] = slot;
        pack.slot[pack.count] = slot++;
        pack.self[pack.count++] = i;
        if (const uint32_t next = younger_[i]; next != kNone && --waiting_[next] == 0) ready(next);
      }
    }
    for (uint32_t k = 0; k < pack.count; ++k) {
      const uint32_t parent = parent_[pack.self[k]];
      if (inside(parent) && --waiting_[parent] == 0) ready(parent);
    }
    while (top > bottom && first_[top] == kNone) --top;
    done += pack.count;
    packs_.push_back(pack);
  }
  for (const uint32_t i : members) {
    if (is_top || inside(parent_[i])) continue;
    next_[i] = block_slots_++;
    extend_adds_.push_back({next_[i], slot_[parent_[i]]});
  }
  for (lanes::Pack& pack : std::span(packs_).subspan(first_pack)) {
    for (uint32_t k = 0; k < 4; ++k) {
      if (k >= pack.count) {
        pack.self[k] = pack.self[0], pack.slot[k] = pack.slot[0];
        pack.parent[k] = pack.parent[0], pack.up[k] = pack.up[0];
        continue;
      }
      const uint32_t parent = parent_[pack.self[k]];
      pack.parent[k] = pack.up[k] = slot_[parent];
      if (!is_top && !inside(parent)) pack.up[k] = next_[pack.self[k]];
    }
  }
  return {first_pack, static_cast<uint32_t>(packs_.size()), first_extend_add};
}

}  // namespace liana
