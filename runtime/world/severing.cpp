#include "runtime/world/severing.h"

#include <fmt/core.h>

#include <algorithm>

namespace liana {
namespace {

constexpr size_t kMostBreaksAStep = 8;  // of one plant; what remains overloaded breaks in the next
constexpr double kStillWithin = 0.01;   // m, that a part moves at most while it is at rest
constexpr double kAway = 500;           // m from the origin, beyond which a part has left the scene
constexpr double kTearOff = 0.02;       // m, at which a dead root lets go

}  // namespace

Detachment Severing::take_off(Garden& garden, size_t plant, ParticleId particle) const {
  return garden.detach(
      plant, particle,
      fmt::format("{} part {}", garden[plant].plant.name, done_.broken + done_.shed + done_.cut));
}

Detachment Severing::cut(Garden& garden, size_t plant, ParticleId particle) {
  Detachment off = take_off(garden, plant, particle);
  ++done_.cut;
  return off;
}

void Severing::look_for_fractures(PlantInstance& plant) const {
  find_fractures(plant.plant, kMostBreaksAStep, plant.fractures);
}

// From the last id to the first: taking a particle off leaves those before it where they are.
std::optional<Fracture> Severing::next_fracture(PlantInstance& plant) const {
  std::vector<Fracture>& found = plant.fractures;
  const auto last = std::max_element(found.begin(), found.end(),
                                     [](const Fracture& a, const Fracture& b) { return a.at < b.at; });
  if (last == found.end()) return std::nullopt;
  const Fracture fracture = *last;
  found.erase(last);
  return fracture;
}

Detachment Severing::break_off(Garden& garden, size_t plant, ParticleId particle) {
  const Plant& from = garden[plant].plant;
  const bool leaf = from.branches[from.particles[particle.index()].branch.index()].kind == DomainKind::Leaf;
  ++(leaf ? done_.shed : done_.broken);
  return take_off(garden, plant, particle);
}

void Severing::let_rest(PlantInstance& part, double dt) const {
  if (!part.detached) return;
  DetachedPart& rest = *part.detached;
  rest.seconds += dt;
  Plant& plant = part.plant;
  std::erase_if(plant.anchors, [&](const WorldSpring& anchor) {
    const Motion& motion = plant.motion[anchor.particle.index()];
    const Vec3 point = motion.position + motion.orientation * anchor.on_particle;
    return rest.seconds > fate_.roots_hold || (point - anchor.target).norm() > kTearOff;
  });
  // Root mean square by mass: a leaf that trembles does not keep a branch awake.
  double moved = 0, mass = 0;
  rest.lay.resize(plant.particles.size(), Vec3::Zero());
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    moved += plant.particles[i].mass * (plant.motion[i].position - rest.lay[i]).squaredNorm();
    mass += plant.particles[i].mass;
  }
  rest.still += dt;
  if (moved > kStillWithin * kStillWithin * mass || !plant.anchors.empty()) {
    for (size_t i = 0; i < plant.particles.size(); ++i) rest.lay[i] = plant.motion[i].position;
    rest.still = 0;
  }
  if (!rest.asleep()) return;
  for (Motion& motion : plant.motion)
    motion = {.position = motion.position, .orientation = motion.orientation};
}

void Severing::remove_parts(Garden& garden, Grabs& grabs, double dt) {
  for (size_t i = garden.size(); i-- > 0;) {
    PlantInstance& part = garden[i];
    if (!part.detached) continue;
    if (part.asleep()) part.detached->still += dt;
    const bool rested =
        fate_.remove_after > 0 && part.detached->still >= DetachedPart::kStillFor + fate_.remove_after;
    if (!rested && part.plant.motion[0].position.norm() < kAway) continue;
    if (grabs.hold_on_to(i)) continue;
    departed_.add(part.report);
    garden.remove(i);
    grabs.forget(i);
    ++done_.removed;
  }
}

void Severing::add_to(WorldReport& report) const {
  static_cast<SeveringReport&>(report) = done_;
  report.add(departed_);
}

}  // namespace liana
