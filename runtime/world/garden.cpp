#include "runtime/world/garden.h"

#include <algorithm>

#include "mesher/base/state_bytes.h"
#include "mesher/base/stopwatch.h"
#include "runtime/world/planting.h"

namespace liana {
namespace {

constexpr size_t kLarge = 1000;  // particles of a plant whose step is worth sharing

}  // namespace

Garden::Garden(const Scene& scene, std::vector<std::string>& notes)
    : contact_weights_(scene.contact_weights),
      touching_({.material = scene.plant_contact_material, .weights = scene.contact_weights}) {
  const auto add = [&](Planted planted) {
    planted.instance->origin = plants_.size();
    plants_.push_back(std::move(planted.instance));
    origins_.push_back(std::move(planted.origin));
  };
  for (const ScenePlant& entry : scene.plants) add(plant_baked(scene, entry, notes));
  for (size_t i = 0; i < scene.climbers.size(); ++i)
    add(plant_climber(scene, scene.climbers[i], scene.seed + i, notes));
}

void Garden::take_removals() {
  for (size_t i = 0; i < plants_.size(); ++i) {
    PlantInstance& self = *plants_[i];
    self.stepper.take(self.plant);
    touching_.take(i, self.plant);
    if (self.climber) self.climber->take(self.plant);
    self.plant.removals.clear();
  }
}

void Garden::grow(size_t plant, std::span<const SdfObstacle* const> solids, const Vec3& to_sun, double dt) {
  PlantInstance& self = *plants_[plant];
  if (!self.climber) return;
  self.report.growth_seconds += timed([&] {
    self.climber->grow(self.plant, solids, to_sun, origin_of(self).growth_speed * dt);
    self.climber->mark_growing(self.plant, self.growing);
  });
}

void Garden::touch() {
  all_plants_.clear();
  all_springs_.clear();
  for (const auto& plant : plants_) {
    all_plants_.push_back(&plant->plant);
    all_springs_.push_back(&plant->springs);
  }
  touching_seconds_ += timed([&] { touched_ = touching_.gather(all_plants_, all_springs_); });
  max_overlap_ = std::max(max_overlap_, touched_.max_overlap);
}

std::span<const PlantInWind> Garden::in_wind() {
  in_wind_.clear();
  for (const auto& plant : plants_) in_wind_.push_back({&plant->plant, plant->growing});
  return in_wind_;
}

size_t Garden::large_ones() const {
  return static_cast<size_t>(std::count_if(plants_.begin(), plants_.end(), [](const auto& plant) {
    return plant->plant.particles.size() >= kLarge && !plant->asleep();
  }));
}

Detachment Garden::detach(size_t plant, ParticleId particle, std::string name) {
  PlantInstance& from = *plants_[plant];
  auto part = std::make_unique<PlantInstance>(ContactOptions{.weights = contact_weights_});
  Detachment cut{plant, plants_.size(), {}, {}};
  part->plant = detach_subtree(from.plant, particle, &cut.change, &cut.origin);
  part->plant.name = std::move(name);
  part->origin = from.origin;
  part->detached.emplace();
  from.growing.clear();
  if (from.detached) from.detached->lay.clear();
  plants_.push_back(std::move(part));
  return cut;
}

void Garden::have_parts_for(size_t count) {
  constexpr size_t kMost = 1u << 20;
  if (count < origins_.size() || count > kMost) state_mismatch();
  plants_.resize(count);
  for (auto& plant : plants_)
    if (!plant) plant = std::make_unique<PlantInstance>(ContactOptions{.weights = contact_weights_});
}

void Garden::remove(size_t part) {
  touching_.forget(static_cast<uint32_t>(part));
  plants_.erase(plants_.begin() + static_cast<std::ptrdiff_t>(part));
}

void Garden::add_to(WorldReport& report) const {
  for (const auto& plant : plants_) {
    report.particles += plant->plant.particles.size();
    report.anchors += plant->plant.anchors.size();
    report.contacts += plant->report.contacts;
    report.detached += plant->detached.has_value();
    report.asleep += plant->asleep();
    report.add(plant->report);
  }
  report.plant_contacts = touched_.contacts;
  report.grown_together = touched_.exempt;
  report.max_overlap = max_overlap_;
  report.seconds.touching = touching_seconds_;
}

}  // namespace liana
