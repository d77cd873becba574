#include "runtime/sim/elimination_order.h"

#include <algorithm>

namespace liana {

namespace {
constexpr uint32_t kNone = ParticleId::kNone;
}

bool EliminationOrder::update(std::span<const Particle> particles) {
  const auto count = static_cast<uint32_t>(particles.size());
  bool same = parent_.size() == count;
  if (!same) parent_.assign(count, kNone - 1);
  for (uint32_t i = 0; i < count; ++i) {
    const ParticleId parent = particles[i].parent;
    const uint32_t now = parent.valid() ? parent.value : count;
    same = same && parent_[i] == now;
    parent_[i] = now;
  }
  if (!same) build();
  return !same;
}

void EliminationOrder::build() {
  const auto count = static_cast<uint32_t>(parent_.size());
  depth_.assign(count + 1, 0);
  waiting_.assign(count + 1, 0);
  next_.assign(count, kNone);
  uint32_t deepest = 0;
  for (uint32_t i = 0; i < count; ++i) {
    depth_[i] = parent_[i] == count ? 0 : depth_[parent_[i]] + 1;
    deepest = std::max(deepest, depth_[i]);
    ++waiting_[parent_[i]];
  }
  first_.assign(deepest + 1, kNone);
  last_.assign(deepest + 1, kNone);
  const auto ready = [&](uint32_t i) {
    uint32_t& last = last_[depth_[i]];
    (last == kNone ? first_[depth_[i]] : next_[last]) = i;
    last = i;
  };
  for (uint32_t i = 0; i < count; ++i)
    if (waiting_[i] == 0) ready(i);

  packs_.clear();
  packs_.reserve(count / 4 + deepest + 1);
  for (uint32_t done = 0, top = deepest; done < count;) {
    lanes::Pack pack{};
    for (uint32_t depth = top + 1; depth-- > 0 && pack.count < 4;) {
      while (pack.count < 4 && first_[depth] != kNone) {
        const uint32_t i = first_[depth];
        first_[depth] = next_[i];
        if (first_[depth] == kNone) last_[depth] = kNone;
        pack.self[pack.count] = i;
        pack.parent[pack.count++] = parent_[i];
      }
    }
    for (uint32_t k = 0; k < pack.count; ++k)
      if (pack.parent[k] != count && --waiting_[pack.parent[k]] == 0) ready(pack.parent[k]);
    for (uint32_t k = pack.count; k < 4; ++k) pack.self[k] = pack.self[0], pack.parent[k] = pack.parent[0];
    while (top > 0 && first_[top] == kNone) --top;
    done += pack.count;
    packs_.push_back(pack);
  }
}

}  // namespace liana
