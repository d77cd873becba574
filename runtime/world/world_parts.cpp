// The world's plants lose parts: cuts, breaks, and what becomes of the fallen.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"
#include "runtime/world/world.h"

namespace liana {
namespace {

constexpr double kStretchUnderWeight = 0.02;  // m: of a grab that holds the whole plant
constexpr double kStillWithin = 0.01;         // m, that a part moves at most while it is at rest
constexpr double kStillFor = 1;               // s, after which it sleeps
constexpr double kAway = 500;                 // m from the origin, beyond which a part has left the scene
constexpr double kTearOff = 0.02;             // m, at which a dead root lets go

double weight_of(const Plant& plant) {
  double mass = 0;
  for (const Particle& particle : plant.particles) mass += particle.mass;
  return 9.81 * mass;
}

}  // namespace

bool World::Inhabitant::asleep() const {
  return fallen && still_for >= kStillFor;
}

void World::check_point(const ScenePoint& point, const char* table) const {
  if (point.domain.empty()) return;
  const std::vector<std::string>& names = inhabitants_[point.index]->domains;
  for (size_t i = 0; i < names.size(); ++i)
    if (point.domain == names[i] || point.domain == "#" + std::to_string(i)) return;
  throw Error(Error::Kind::Input,
              fmt::format("{}: {} names '{}', but '{}' has no such branch or leaf", scene_.file.string(),
                          table, point.domain, inhabitants_[point.index]->plant.name),
              fmt::format("did you mean '{}'?", nearest_word(point.domain, names)));
}

std::optional<std::pair<size_t, ParticleId>> World::find(const ScenePoint& point) const {
  const size_t index = point.index + (point.climber ? scene_.plants.size() : 0);
  const Inhabitant& self = *inhabitants_[index];
  ParticleId best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const Branch& branch : self.plant.branches) {
    if (!point.domain.empty()) {
      const bool named =
          branch.domain.valid() && (point.domain == self.domains[branch.domain.index()] ||
                                    point.domain == "#" + std::to_string(branch.domain.index()));
      if (!named) continue;
      const size_t count = branch.particles.size();
      return std::pair{index, branch.particles[std::min(
                                  count - 1, static_cast<size_t>(point.along * static_cast<double>(count)))]};
    }
    if (branch.kind == DomainKind::Leaf) continue;
    for (const ParticleId id : branch.particles) {
      const double distance = (self.plant.motion[id.index()].position - point.at).norm();
      if (distance < best_distance) best = id, best_distance = distance;
    }
  }
  if (!best.valid()) return std::nullopt;
  return std::pair{index, best};
}

void World::start_events() {
  const auto now = [&](double when) {
    return static_cast<size_t>(std::lround(when / scene_.time_step)) == steps_;
  };
  const auto gone = [&](const char* what) {
    notes_.push_back(fmt::format("at {:.2f} s: nothing was left to {}", time(), what));
  };
  for (const SceneCut& entry : scene_.cuts) {
    if (!now(entry.time)) continue;
    if (const auto place = find(entry.where))
      cut(place->first, place->second);
    else
      gone("cut");
  }
  for (const SceneGrab& entry : scene_.grabs) {
    if (!now(entry.time)) continue;
    const auto place = find(entry.where);
    if (!place) {
      gone("grab");
      continue;
    }
    const Plant& plant = inhabitants_[place->first]->plant;
    const double stiffness = entry.strength * weight_of(plant) / kStretchUnderWeight;
    WorldSpring spring;
    spring.particle = place->second;
    spring.stiffness = stiffness * Mat3::Identity();
    spring.damping = 2 * scene_.time_step * spring.stiffness;
    scripted_.push_back({place->first, spring, plant.motion[place->second.index()].position, &entry});
  }
}

void World::lead_grabs() {
  std::erase_if(scripted_, [&](const ScriptedGrab& grab) {
    return time() > grab.script->time + grab.script->seconds + 1e-9;
  });
  for (ScriptedGrab& grab : scripted_) {
    const std::vector<Vec3>& path = grab.script->path;
    const auto place = [&](double when) -> Vec3 {
      const double legs = static_cast<double>(path.size());
      const double way = std::clamp((when - grab.script->time) / grab.script->seconds, 0.0, 1.0) * legs;
      const size_t leg = std::min(static_cast<size_t>(way), path.size() - 1);
      const Vec3 start = leg == 0 ? Vec3(Vec3::Zero()) : path[leg - 1];
      return grab.from + start + (way - static_cast<double>(leg)) * (path[leg] - start);
    };
    const double dt = scene_.time_step;
    grab.spring.target = place(time() + dt);
    grab.spring.target_velocity = (grab.spring.target - place(time())) / dt;
    inhabitants_[grab.plant]->still_for = 0;
  }
}

void World::cut(size_t plant, ParticleId particle) {
  require(plant < inhabitants_.size() && particle.index() < inhabitants_[plant]->plant.particles.size(),
          "World::cut: no such particle");
  take_off(plant, particle);
  ++cut_;
}

void World::break_what_is_overloaded() {
  const size_t count = inhabitants_.size();  // what falls now is looked at after its first step
  for (size_t i = 0; i < count; ++i) {
    std::vector<Fracture> fractures;
    fractures.swap(inhabitants_[i]->fractures);
    // From the last id to the first: taking a particle off leaves those before it where they are.
    std::sort(fractures.begin(), fractures.end(),
              [](const Fracture& a, const Fracture& b) { return b.at < a.at; });
    for (const Fracture& fracture : fractures) {
      const Plant& plant = inhabitants_[i]->plant;
      const bool leaf =
          plant.branches[plant.particles[fracture.at.index()].branch.index()].kind == DomainKind::Leaf;
      ++(leaf ? shed_ : broken_);
      take_off(i, fracture.at);
    }
  }
}

void World::take_off(size_t index, ParticleId particle) {
  auto part = std::make_unique<Inhabitant>(ContactOptions{.weights = scene_.contact_weights});
  Inhabitant& from = *inhabitants_[index];
  TopologyChange change;
  DetachedFrom origin;
  part->plant = detach_subtree(from.plant, particle, &change, &origin);
  part->look = from.look;
  part->domains = from.domains;
  part->fallen = true;
  part->plant.name = fmt::format("{} part {}", from.plant.name, broken_ + shed_ + cut_);
  from.stepper.follow(change);
  touching_.follow(static_cast<uint32_t>(index), change);
  if (from.climber) from.climber->follow(change);
  from.growing.clear();
  from.lay.clear();
  from.fractures.clear();

  const size_t part_index = inhabitants_.size();
  const auto follow = [&](auto& grab) {
    if (grab.plant != index) return;
    const ParticleId old = grab.spring.particle;
    grab.spring.particle = change.particles[old.index()];
    if (grab.spring.particle.valid()) return;
    const auto found = std::lower_bound(origin.particles.begin(), origin.particles.end(), old);
    grab.plant = part_index;
    grab.spring.particle = ParticleId(static_cast<size_t>(found - origin.particles.begin()));
  };
  if (grabbed_) follow(*grabbed_);
  for (ScriptedGrab& grab : scripted_) follow(grab);
  std::erase_if(plucks_, [&](Pluck& pluck) {
    if (pluck.plant != index || pluck.step < steps_) return false;
    pluck.branch = change.branches[pluck.branch.index()];
    if (pluck.branch.valid()) return false;
    notes_.push_back(fmt::format("a branch that [[pluck]] names had come off {} before", from.plant.name));
    return true;
  });
  inhabitants_.push_back(std::move(part));
}

// A part that lies still for a while is not moved any more; its roots die.
void World::let_rest(Inhabitant& part) const {
  const double dt = scene_.time_step;
  part.fallen_for += dt;
  Plant& plant = part.plant;
  std::erase_if(plant.anchors, [&](const WorldSpring& anchor) {
    const Motion& motion = plant.motion[anchor.particle.index()];
    const Vec3 point = motion.position + motion.orientation * anchor.on_particle;
    return part.fallen_for > scene_.fallen.roots_hold || (point - anchor.target).norm() > kTearOff;
  });
  // Root mean square by mass: a leaf that trembles does not keep a branch awake.
  double moved = 0, mass = 0;
  part.lay.resize(plant.particles.size(), Vec3::Zero());
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    moved += plant.particles[i].mass * (plant.motion[i].position - part.lay[i]).squaredNorm();
    mass += plant.particles[i].mass;
  }
  part.still_for += dt;
  if (moved > kStillWithin * kStillWithin * mass || !plant.anchors.empty()) {
    for (size_t i = 0; i < plant.particles.size(); ++i) part.lay[i] = plant.motion[i].position;
    part.still_for = 0;
  }
  if (!part.asleep()) return;
  for (Motion& motion : plant.motion)
    motion = {.position = motion.position, .orientation = motion.orientation};
}

void World::remove_parts() {
  const double keep = scene_.fallen.remove_after;
  for (size_t i = inhabitants_.size(); i-- > 0;) {
    Inhabitant& part = *inhabitants_[i];
    if (!part.fallen) continue;
    if (part.asleep()) part.still_for += scene_.time_step;
    const bool rested = keep > 0 && part.still_for >= kStillFor + keep;
    if (!rested && part.plant.motion[0].position.norm() < kAway) continue;
    if (grabbed_ && grabbed_->plant == i) continue;
    if (std::any_of(scripted_.begin(), scripted_.end(), [&](const ScriptedGrab& g) { return g.plant == i; }))
      continue;
    add(part.report, departed_);
    touching_.forget(static_cast<uint32_t>(i));
    inhabitants_.erase(inhabitants_.begin() + static_cast<std::ptrdiff_t>(i));
    if (grabbed_ && grabbed_->plant > i) --grabbed_->plant;
    for (ScriptedGrab& grab : scripted_)
      if (grab.plant > i) --grab.plant;
    ++removed_;
  }
}

}  // namespace liana
