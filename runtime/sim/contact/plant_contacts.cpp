#include "runtime/sim/contact/plant_contacts.h"

#include <algorithm>

#include "mesher/base/error.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/joints.h"

namespace liana {
namespace {

constexpr float kApart = 5e-4f;       // m, beyond which an exempt pair counts as come apart
constexpr double kImpactSpeed = 0.1;  // m/s, beyond which elasticity shows
constexpr float kRounding = 1e-5f;    // m, that single precision may take from a box

/// m/s, of the particle's ends as it turns.
double turning_speed(const Particle& particle, const Motion& motion) {
  return std::max(particle.half_length, particle.half_width) * motion.angular_velocity.norm();
}

/// kg: what a free particle opposes to a push along n (unit) at a lever from its centre (m).
double mass_at(const Particle& particle, const Motion& motion, const Vec3& arm, const Vec3& n) {
  const Vec3 turning = motion.orientation.conjugate() * arm.cross(n);
  return 1 / (1 / particle.mass + turning.cwiseAbs2().dot(particle.inertia.cwiseMax(1e-15).cwiseInverse()));
}

}  // namespace

void PlantContacts::look_at(std::span<const Plant* const> plants) {
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
      const Body& body =
          bodies_.emplace_back(Body{Outline({particle, m, blade}), static_cast<float>(way), k, i});
      const Eigen::Vector3f &x = body.outline.centre, along = body.outline.half_box();
      const float around = body.way + kRounding;
      const FlatBox::Corner centre{x.x(), x.y(), x.z(), 0},
          half{along.x() + around, along.y() + around, along.z() + around, 0};
      boxes_.push_back({centre - half, centre + half});
    }
  }
}

// Every body when some came or went; else those that left the box that the list looks at.
void PlantContacts::find_moved(std::span<const Plant* const> plants) {
  bool same = sizes_.size() == plants.size() && listed_.size() == boxes_.size();
  for (size_t k = 0; same && k < plants.size(); ++k) same = sizes_[k] == plants[k]->particles.size();
  moved_.assign(boxes_.size(), !same);
  moved_count_ = same ? 0 : boxes_.size();
  for (size_t i = 0; same && i < boxes_.size(); ++i) {
    moved_[i] = !listed_[i].holds(boxes_[i]);
    moved_count_ += moved_[i];
  }
  if (moved_count_ > boxes_.size() / 3) moved_.assign(boxes_.size(), 1), moved_count_ = boxes_.size();
}

void PlantContacts::take(size_t plant, const Plant& of) {
  if (slots_.size() <= plant) slots_.resize(plant + 1);
  slots_[plant].take(of.removals, [&](const Remap& remap) {
    std::erase_if(memory_, [&](Memory& m) {
      for (uint64_t* name : {&m.a, &m.b}) {
        if (*name >> 32 != plant) continue;
        const ParticleId now = remap.particles[*name & kNone];
        if (!now.valid()) return true;
        *name = uint64_t{plant} << 32 | now.index();
      }
      return false;
    });
    sizes_.clear();  // the list is made anew
  });
}

void PlantContacts::forget(uint32_t plant) {
  if (plant < slots_.size()) slots_.erase(slots_.begin() + plant);
  std::erase_if(memory_, [&](Memory& m) {
    for (uint64_t* name : {&m.a, &m.b}) {
      if (*name >> 32 == plant) return true;
      if (*name >> 32 > plant) *name -= uint64_t{1} << 32;
    }
    return false;
  });
  sizes_.clear();
}

// Neighbours in the tree share a joint or nearly so.
bool PlantContacts::near_kin(uint32_t a, uint32_t b) const {
  const Body &x = bodies_[a], &y = bodies_[b];
  if (x.plant != y.plant) return false;
  const Kin &of_x = kin_[a], &of_y = kin_[b];
  if (x.outline.blade && of_x.branch == of_y.branch) return true;
  return of_x.parent == y.particle || of_y.parent == x.particle || of_x.grandparent == y.particle ||
         of_y.grandparent == x.particle ||
         (of_x.parent != kNone && (of_x.parent == of_y.parent || of_x.parent == of_y.grandparent)) ||
         (of_x.grandparent != kNone && of_x.grandparent == of_y.parent);
}

void PlantContacts::list_moved(std::span<const Plant* const> plants) {
  listed_.resize(bodies_.size());
  kin_.resize(bodies_.size());
  for (size_t i = 0; i < bodies_.size(); ++i) {
    if (!moved_[i]) continue;
    const Plant& plant = *plants[bodies_[i].plant];
    const auto above = [&](uint32_t p) {
      const ParticleId parent = p == kNone ? ParticleId() : plant.particles[p].parent;
      return parent.valid() ? static_cast<uint32_t>(parent.index()) : kNone;
    };
    const uint32_t parent = above(bodies_[i].particle);
    kin_[i] = {parent, above(parent), plant.particles[bodies_[i].particle].branch};
    // The box holds one step's way already; the list is to last for several.
    const Vec3 on = options_.list_steps * plant.scheme.dt * plant.motion[bodies_[i].particle].velocity;
    const Eigen::Vector3f to = on.cast<float>(), ahead = to.cwiseMax(0.0f), behind = to.cwiseMin(0.0f);
    const auto margin = static_cast<float>(options_.margin);
    listed_[i] = {boxes_[i].low + FlatBox::Corner{behind.x(), behind.y(), behind.z(), 0} - margin,
                  boxes_[i].high + FlatBox::Corner{ahead.x(), ahead.y(), ahead.z(), 0} + margin};
  }
  tree_.fit(listed_);

  // What pairs of moved ones remember.
  forgotten_.clear();
  const bool all = moved_count_ == bodies_.size();
  if (all) {
    for (uint32_t m = 0; m < memory_.size(); ++m) forgotten_.push_back({memory_[m].key(), m});
    candidates_.clear();
  } else {
    std::erase_if(candidates_, [&](const Candidate& c) {
      if (!moved_[c.a] && !moved_[c.b]) return false;
      if (c.memory != kNone) forgotten_.push_back({memory_[c.memory].key(), c.memory});
      return true;
    });
  }
  std::sort(forgotten_.begin(), forgotten_.end());
  const auto offer = [&](uint32_t a, uint32_t b) {
    if (near_kin(a, b)) return;
    Candidate candidate{a, b, kNone};
    if (!forgotten_.empty()) {
      const std::pair key(bodies_[a].name(), bodies_[b].name());
      const auto found = std::lower_bound(forgotten_.begin(), forgotten_.end(), std::pair(key, uint32_t{0}));
      if (found != forgotten_.end() && found->first == key) candidate.memory = found->second;
    }
    candidates_.push_back(candidate);
  };
  if (all) {
    tree_.all(offer);
    return;
  }
  for (uint32_t i = 0; i < bodies_.size(); ++i)
    if (moved_[i])
      tree_.of(i, [&](uint32_t other) {
        if (other == i || (moved_[other] && other < i)) return;  // met from the other side
        offer(std::min(i, other), std::max(i, other));
      });
}

PlantContactReport PlantContacts::gather(std::span<const Plant* const> plants,
                                         std::span<std::vector<WorldSpring>* const> springs) {
  require(springs.size() == plants.size(), "every plant has a list of springs");
  PlantContactReport report;
  for (size_t k = 0; k < plants.size(); ++k) take(k, *plants[k]);
  look_at(plants);
  find_moved(plants);
  if (moved_count_ > 0) list_moved(plants);
  report.listed = moved_count_;
  next_memory_.clear();
  for (Candidate& candidate : candidates_) {
    if (candidate.memory == kNone) {
      if (!boxes_[candidate.a].meets(boxes_[candidate.b])) continue;
      const Body &a = bodies_[candidate.a], &b = bodies_[candidate.b];
      if (a.outline.apart(b.outline, kApart + a.way + b.way)) continue;
    }
    touch(candidate, plants, springs, report);
  }
  memory_.swap(next_memory_);
  report.candidates = candidates_.size();
  sizes_.resize(plants.size());
  for (size_t k = 0; k < plants.size(); ++k) sizes_[k] = plants[k]->particles.size();
  return report;
}

void PlantContacts::touch(Candidate& candidate, std::span<const Plant* const> plants,
                          std::span<std::vector<WorldSpring>* const> springs, PlantContactReport& report) {
  const uint32_t old = std::exchange(candidate.memory, kNone);
  const Body &a = bodies_[candidate.a], &b = bodies_[candidate.b];
  const Plant &plant_a = *plants[a.plant], &plant_b = *plants[b.plant];
  const Motion &ma = plant_a.motion[a.particle], &mb = plant_b.motion[b.particle];
  const Particle &pa = plant_a.particles[a.particle], &pb = plant_b.particles[b.particle];
  const double dt = plant_a.scheme.dt;
  const Vec3 acceleration = ma.acceleration - mb.acceleration;

  Memory memory{a.name(), b.name(), Vec3::Zero(), false, {}};
  if (old != kNone) memory = memory_[old];
  const Vec3* side = old != kNone && !memory.exempt ? &memory.normal : nullptr;
  const double far = kApart + dt * (mb.velocity - ma.velocity).norm() +
                     dt * (turning_speed(pa, ma) + turning_speed(pb, mb) + dt / 2 * acceleration.norm());
  const Meeting met = meet({pa, ma, a.outline.blade}, {pb, mb, b.outline.blade}, side, far);
  if (met.gap > far) return;
  const Vec3 &n = met.normal, &arm_a = met.arm_a, &arm_b = met.arm_b;
  const double gap = met.gap;
  const Vec3 velocity_a = ma.velocity + ma.angular_velocity.cross(arm_a);
  const Vec3 velocity_b = mb.velocity + mb.angular_velocity.cross(arm_b);
  const Vec3 velocity = velocity_a - velocity_b;

  const auto is_new = [&](const Body& body) {
    return body.plant >= sizes_.size() || body.particle >= sizes_[body.plant];
  };
  if (old == kNone && gap < 0 && (is_new(a) || is_new(b))) memory.exempt = true;
  if (memory.exempt && gap < kApart) {
    ++report.exempt;
    candidate.memory = static_cast<uint32_t>(next_memory_.size());
    next_memory_.push_back(memory);
    return;
  }
  memory.exempt = false;
  const double approach = velocity.dot(n);
  const double coming = std::min(0.0, dt * approach + dt * dt / 2 * acceleration.dot(n));
  // What settles is not let go on its way down (see contacts.cpp); what has bounced leaves by itself.
  if (gap + (side ? 3 : 1) * coming >= 0 || (options_.feel.elasticity > 0 && approach > kImpactSpeed)) return;
  ++report.contacts;
  report.max_overlap = std::max(report.max_overlap, -gap);
  memory.normal = n;

  // Reduced mass, and how much of the way each one goes: k / share has the same frequency for both.
  const double of_a = mass_at(pa, ma, arm_a, n), of_b = mass_at(pb, mb, arm_b, n);
  const double sum = std::max(of_a + of_b, 1e-12);
  const double share_a = std::clamp(of_b / sum, 1e-3, 1 - 1e-3);
  const double reduced = sum * share_a * (1 - share_a);
  // Springs to the world resist the acceleration of what moves together like a mass of kΔt²: soft where a
  // touch is light, hard where it would be deep. The force k₀δ (1 + d²), d the depth by met.soft, with
  // its own slope.
  const double depth = std::clamp(-(gap + coming) / met.soft, 0.0, options_.deepest);
  const double light = options_.stiffness_ratio * reduced / (dt * dt);
  const double bearable = std::min(bearable_force(pa), bearable_force(pb)) / std::max(1e-9, -gap);
  const double k = std::clamp(bearable, light / 4, light * (1 + 3 * depth * depth));
  const double secant = std::min(k, light * (1 + depth * depth));
  const GeneralizedAlpha method(plant_a.scheme.rho_infinity);
  const double at_end = 1 - method.alpha_f;

  const Vec3 sliding = velocity - approach * n;
  const auto flat = [&](const Vec3& x) { return Vec3(x - x.dot(n) * n); };
  const Vec3 point_a = ma.orientation.conjugate() * arm_a, point_b = mb.orientation.conjugate() * arm_b;
  if (!memory.grip.holds) memory.grip.on_a = point_a, memory.grip.on_b = point_b;
  const Vec3 slip =
      flat(ma.position + ma.orientation * memory.grip.on_a - mb.position - mb.orientation * memory.grip.on_b);
  const double limit = options_.feel.friction * at_end * secant * std::max(0.0, -gap);
  const bool was_slipping = !memory.grip.holds;
  const FrictionAnswer friction = friction_answer(memory.grip, was_slipping ? Vec3::Zero() : slip, sliding,
                                                  flat(acceleration), at_end * k, limit, reduced, dt);

  const bool bounces = options_.feel.elasticity > 0 && approach < -kImpactSpeed;
  const double out =
      a.outline.blade || b.outline.blade ? options_.blades_apart_speed : options_.push_out_speed;
  const double way = std::min(-gap, out * dt);  // to be gone by both together
  const double push_out = way > 0 ? secant / k * way : way;
  const double settling = dt * std::clamp(1.25 - std::max(0.0, -approach) * dt / 4e-3, 0.25, 1.0);
  const Vec3 common = share_a * velocity_b + (1 - share_a) * velocity_a;
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  const auto push = [&](const Body& body, const Vec3& arm, const Vec3& point, const Vec3& own, double share,
                        double sign) {
    WorldSpring spring;
    spring.particle = ParticleId(body.particle);
    spring.on_particle = point;
    const double stiffness = k / share;
    spring.target = plants[body.plant]->motion[body.particle].position + arm +
                    at_end * (share * sign * (push_out * n + friction.stretch) + dt * common.dot(n) * n);
    spring.stiffness = stiffness * along;
    spring.damping = stiffness * settling * along;
    spring.target_velocity = (method.alpha_f * own + at_end * common).dot(n) * n;
    if (bounces) {
      // An impulse is remembered by generalized-α's acceleration: see contacts.cpp.
      const double gain = method.gamma / (1 - method.alpha_m) * (1 + options_.feel.elasticity);
      const double end = own.dot(n) + gain * (common - own).dot(n);
      spring.stiffness.setZero();
      spring.damping = stiffness * dt * along;
      spring.target_velocity = (method.alpha_f * own.dot(n) + at_end * end) * n;
    }
    if (friction.dashpot > 0) {
      spring.damping += friction.dashpot / share * across;
      spring.target_velocity += flat(common);
    } else if (memory.grip.holds) {
      spring.target += at_end * dt * flat(common);
      spring.stiffness += stiffness * across;
      spring.damping += stiffness * dt * across;
      spring.target_velocity += flat(method.alpha_f * own + at_end * common);
    }
    springs[body.plant]->push_back(spring);
  };
  push(a, arm_a, point_a, velocity_a, share_a, 1);
  push(b, arm_b, point_b, velocity_b, 1 - share_a, -1);
  candidate.memory = static_cast<uint32_t>(next_memory_.size());
  next_memory_.push_back(memory);
}

}  // namespace liana
