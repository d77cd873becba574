#include "runtime/sim/contact/broad_phase.h"

#include <algorithm>

#include "runtime/sim/contact/make_room.h"

namespace liana {
namespace {

constexpr float kRounding = 1e-5f;  // m, that single precision may take from a box

}  // namespace

double turning_speed(const Particle& particle, const Motion& motion) {
  return std::max(particle.half_length, particle.half_width) * motion.angular_velocity.norm();
}

void BroadPhase::update(std::span<const Plant* const> plants, std::span<const CachedContact> cache) {
  look_at(plants);
  find_moved(plants);
  if (moved_count_ == 0) return;
  list_moved(plants);
  take_out_moved(cache);
  if (moved_count_ == bodies_.size()) {
    tree_.pairs([&](uint32_t a, uint32_t b) { offer(a, b); });
    // Crowns that swing into each other list several times as many as at rest.
    make_room(pairs_, std::max(pairs_.size(), 16 * bodies_.size()));
    return;
  }
  for (uint32_t i = 0; i < bodies_.size(); ++i)
    if (moved_[i])
      tree_.overlaps_of(i, [&](uint32_t other) {
        if (other == i || (moved_[other] && other < i)) return;  // met from the other side
        offer(std::min(i, other), std::max(i, other));
      });
}

void BroadPhase::end(std::span<const Plant* const> plants) {
  sizes_.resize(plants.size());
  for (size_t k = 0; k < plants.size(); ++k) sizes_[k] = plants[k]->particles.size();
}

bool BroadPhase::may_touch(const Pair& pair, float apart) const {
  if (!boxes_[pair.a].overlaps(boxes_[pair.b])) return false;
  const Body &a = bodies_[pair.a], &b = bodies_[pair.b];
  return !a.outline.apart(b.outline, apart + a.way + b.way);
}

void BroadPhase::look_at(std::span<const Plant* const> plants) {
  bodies_.clear();
  boxes_.clear();
  for (uint32_t k = 0; k < plants.size(); ++k) {
    const Plant& plant = *plants[k];
    const double dt = plant.scheme.dt;
    for (uint32_t i = 0; i < plant.particles.size(); ++i) {
      const Particle& particle = plant.particles[i];
      const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
      const Motion& m = plant.motion[i];
      const double way =
          dt * (m.velocity.norm() + turning_speed(particle, m) + dt / 2 * m.acceleration.norm());
      const Body& body = bodies_.emplace_back(
          Body{Outline({particle, m, blade}), static_cast<float>(way), ParticleName{k, i}});
      const Eigen::Vector3f &x = body.outline.centre, along = body.outline.half_box();
      const float around = body.way + kRounding;
      const Aabb::Corner centre{x.x(), x.y(), x.z(), 0},
          half{along.x() + around, along.y() + around, along.z() + around, 0};
      boxes_.push_back({centre - half, centre + half});
    }
  }
}

// Every body when some came or went; else those that left the box that the list looks at.
void BroadPhase::find_moved(std::span<const Plant* const> plants) {
  bool same = sizes_.size() == plants.size() && listed_.size() == boxes_.size();
  for (size_t k = 0; same && k < plants.size(); ++k) same = sizes_[k] == plants[k]->particles.size();
  moved_.assign(boxes_.size(), !same);
  moved_count_ = same ? 0 : boxes_.size();
  for (size_t i = 0; same && i < boxes_.size(); ++i) {
    moved_[i] = !listed_[i].contains(boxes_[i]);
    moved_count_ += moved_[i];
  }
  if (moved_count_ > boxes_.size() / 3) moved_.assign(boxes_.size(), 1), moved_count_ = boxes_.size();
}

void BroadPhase::list_moved(std::span<const Plant* const> plants) {
  listed_.resize(bodies_.size());
  kin_.resize(bodies_.size());
  for (size_t i = 0; i < bodies_.size(); ++i) {
    if (!moved_[i]) continue;
    const auto [own, particle] = bodies_[i].name;
    const Plant& plant = *plants[own];
    const auto above = [&](uint32_t p) {
      const ParticleId parent = p == kNone ? ParticleId() : plant.particles[p].parent;
      return parent.valid() ? static_cast<uint32_t>(parent.index()) : kNone;
    };
    const uint32_t parent = above(particle);
    kin_[i] = {parent, above(parent), plant.particles[particle].branch};
    // The box holds one step's way already; the list is to last for several.
    const Vec3 on = options_.list_steps * plant.scheme.dt * plant.motion[particle].velocity;
    const Eigen::Vector3f to = on.cast<float>(), ahead = to.cwiseMax(0.0f), behind = to.cwiseMin(0.0f);
    const auto margin = static_cast<float>(options_.margin);
    listed_[i] = {boxes_[i].low + Aabb::Corner{behind.x(), behind.y(), behind.z(), 0} - margin,
                  boxes_[i].high + Aabb::Corner{ahead.x(), ahead.y(), ahead.z(), 0} + margin};
  }
  tree_.fit(listed_);
}

// Pairs of moved ones leave the list; what they remember stays known.
void BroadPhase::take_out_moved(std::span<const CachedContact> cache) {
  known_.clear();
  make_room(known_, bodies_.size());
  if (moved_count_ == bodies_.size()) {
    for (uint32_t c = 0; c < cache.size(); ++c) known_.push_back({cache[c].pair, c});
    pairs_.clear();
  } else {
    std::erase_if(pairs_, [&](const Pair& pair) {
      if (!moved_[pair.a] && !moved_[pair.b]) return false;
      if (pair.cached != kNone) known_.push_back({cache[pair.cached].pair, pair.cached});
      return true;
    });
  }
  std::sort(known_.begin(), known_.end());
}

void BroadPhase::offer(uint32_t a, uint32_t b) {
  if (filtered_out(a, b)) return;
  Pair pair{a, b, kNone};
  if (!known_.empty()) {
    const Known wanted{{bodies_[a].name, bodies_[b].name}, 0};
    const auto found = std::lower_bound(known_.begin(), known_.end(), wanted);
    if (found != known_.end() && found->pair == wanted.pair) pair.cached = found->cached;
  }
  pairs_.push_back(pair);
}

// The collision filter.
bool BroadPhase::filtered_out(uint32_t a, uint32_t b) const {
  const Body &x = bodies_[a], &y = bodies_[b];
  if (x.name.plant != y.name.plant) return false;
  const Kin &of_x = kin_[a], &of_y = kin_[b];
  if (x.outline.blade && of_x.branch == of_y.branch) return true;
  return of_x.parent == y.name.particle || of_y.parent == x.name.particle ||
         of_x.grandparent == y.name.particle || of_y.grandparent == x.name.particle ||
         (of_x.parent != kNone && (of_x.parent == of_y.parent || of_x.parent == of_y.grandparent)) ||
         (of_x.grandparent != kNone && of_x.grandparent == of_y.parent);
}

}  // namespace liana
