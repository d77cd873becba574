#include "runtime/sim/step/elimination_order.h"

#include <algorithm>

namespace liana {
namespace {

constexpr uint32_t kNone = ParticleId::kNone;
// A particle takes 1.4 kB on the way up (itself, its motion, pose, block and record), one of the next part
// 0.4 kB: two thirds of a second-level cache of a megabyte. Subtrees are small beside a part, so that parts
// fill.
constexpr uint32_t kLargestPart = 384, kLargestSubtree = 128;

}  // namespace

void EliminationOrder::update(std::span<const Particle> particles, bool changed) {
  const auto count = static_cast<uint32_t>(particles.size());
  if (parent_.size() == count && !changed) return;
  parent_.resize(count);
  for (uint32_t i = 0; i < count; ++i)
    parent_[i] = particles[i].parent.valid() ? particles[i].parent.value : count;
  divide();
}

bool EliminationOrder::still_holds(std::span<const Particle> particles, Part part) const {
  const auto count = static_cast<uint32_t>(parent_.size());
  bool holds = true;
  for (uint32_t p = part.first; p < part.last; ++p) {
    for (const uint32_t i : packs_[p].self) {
      const ParticleId parent = particles[i].parent;
      holds &= (parent.valid() ? parent.value : count) == parent_[i];
    }
  }
  return holds;
}

// Which part every particle belongs to, and the packs of each.
void EliminationOrder::divide() {
  const auto count = static_cast<uint32_t>(parent_.size());
  depth_.resize(count);
  size_.assign(count + 1, 0);
  part_.resize(count);
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

  const uint32_t largest_subtree = count <= kLargestPart ? 0 : kLargestSubtree;
  uint32_t parts = 0, filled = kLargestPart;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t p = parent_[i];
    if (size_[i] > largest_subtree) {
      part_[i] = kNone;
    } else if (p != count && part_[p] != kNone) {
      part_[i] = part_[p];
    } else {
      if (filled + size_[i] > kLargestPart) ++parts, filled = 0;
      filled += size_[i];
      part_[i] = parts - 1;
    }
  }
  start_.assign(parts + 2, 0);  // counting sort by part, the top last
  for (uint32_t& part : part_) {
    part = std::min(part, parts);
    ++start_[part + 1];
  }
  uint32_t widest = 0;
  for (uint32_t k = 0; k <= parts; ++k) {
    if (k < parts) widest = std::max(widest, start_[k + 1]);
    start_[k + 1] += start_[k];
  }
  members_.resize(count);
  for (uint32_t i = 0; i < count; ++i) members_[start_[part_[i]]++] = i;
  for (uint32_t k = parts + 1; k > 0; --k) start_[k] = start_[k - 1];
  start_[0] = 0;

  world_slot_ = slot_[count] = start_[parts + 1] - start_[parts];
  pose_slots_ = block_slots_ = world_slot_ + 1 + widest;
  packs_.clear();
  parts_.clear();
  handovers_.clear();
  const auto members = [&](uint32_t k) {
    return std::span(members_).subspan(start_[k], start_[k + 1] - start_[k]);
  };
  top_ = pack(members(parts));
  const std::vector<lanes::Pack> top(packs_.begin(), packs_.end());
  packs_.clear();
  for (uint32_t k = 0; k < parts; ++k) parts_.push_back(pack(members(k)));
  top_.first = static_cast<uint32_t>(packs_.size());
  top_.last = static_cast<uint32_t>(packs_.size() + top.size());
  packs_.insert(packs_.end(), top.begin(), top.end());
}

EliminationOrder::Part EliminationOrder::pack(std::span<const uint32_t> members) {
  const auto count = static_cast<uint32_t>(parent_.size()), first_pack = static_cast<uint32_t>(packs_.size()),
             first_handover = static_cast<uint32_t>(handovers_.size());
  if (members.empty()) return {first_pack, first_pack, first_handover};
  const uint32_t part = part_[members[0]];
  const bool is_top = part_[members[0]] + 2 == start_.size();
  const auto inside = [&](uint32_t i) { return i != count && part_[i] == part; };
  const auto ready = [&](uint32_t i) {
    uint32_t& last = last_[depth_[i]];
    (last == kNone ? first_[depth_[i]] : next_[last]) = i;
    last = i;
  };
  uint32_t top = 0, bottom = depth_[members[0]], slot = is_top ? 0 : world_slot_ + 1;
  for (const uint32_t i : members) {
    if (inside(parent_[i])) ++waiting_[parent_[i]];
    bottom = std::min(bottom, depth_[i]);
  }
  // Small subtrees first, as when they are in parts of their own; else in the order of the arrays.
  for (const bool small : {true, false}) {
    for (const uint32_t i : members) {
      if (!inside(parent_[i]) || (size_[i] <= kLargestSubtree) != small) continue;
      uint32_t& last = youngest_[parent_[i]];
      if (last != kNone) younger_[last] = i, ++waiting_[i];
      last = i;
    }
  }
  for (const uint32_t i : members) {
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
    handovers_.push_back({next_[i], slot_[parent_[i]]});
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
  return {first_pack, static_cast<uint32_t>(packs_.size()), first_handover};
}

}  // namespace liana
