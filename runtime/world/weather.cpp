#include "runtime/world/weather.h"

#include "mesher/base/stopwatch.h"
#include "runtime/wind/field/steady_gust_wind.h"

namespace liana {
namespace {

std::unique_ptr<WindField> open_wind(const SceneWind& wind, uint64_t seed) {
  if (wind.velocity.norm() == 0) return nullptr;
  if (wind.kind == SceneWind::Kind::Ambient) return std::make_unique<AmbientWind>(wind.ambient);
  GustParameters gusts;
  gusts.mean = wind.velocity;
  gusts.intensity = wind.gust;
  gusts.peak_frequency = 1 / wind.gust_period;
  gusts.seed = seed;
  return std::make_unique<SteadyGustWind>(gusts);
}

}  // namespace

Weather::Weather(const Scene& scene, std::span<const SdfObstacle* const> standing,
                 std::span<const SdfObstacle* const> moving, double ground_height, unsigned threads)
    : open_(open_wind(scene.wind, scene.seed)) {
  if (open_) {
    std::vector<const SdfObstacle*> all(standing.begin(), standing.end());
    all.insert(all.end(), moving.begin(), moving.end());
    sheltered_ = std::make_unique<ShelteredWind>(*open_, std::move(all), ground_height);
  }
  if (!scene.wind.air) return;
  SphWindParameters parameters = *scene.wind.air;
  parameters.threads = threads;
  air_ = std::make_unique<SphWind>(parameters, standing, ground_height, moving);
  coupling_ = std::make_unique<PlantCoupling>(air_->air());
}

void Weather::advance(std::span<const PlantInWind> plants, double time, double dt) {
  seconds_ += timed([&] {
    air_->step(dt, coupling_->set_bodies(plants));
    coupling_->find(plants, sheltered_.get(), time, dt);
  });
}

void Weather::add_to(size_t index, const Plant& plant, double time, std::vector<WorldSpring>& springs,
                     std::vector<Wrench>& wrenches) const {
  if (!air_) {
    if (sheltered_) add_wind(plant, *sheltered_, time, {}, springs);
    return;
  }
  coupling_->dashpots(index, plant, springs);
  wrenches.assign(plant.particles.size(), {});
  coupling_->add_pressure(index, wrenches);
}

void Weather::react(std::span<const PlantInWind> plants) {
  seconds_ += timed([&] { coupling_->react(plants); });
}

}  // namespace liana
