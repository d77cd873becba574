#include "runtime/scene/world.h"

#include <fmt/core.h>

#include <algorithm>

#include "materials/bake/bake_file.h"
#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "mesher/base/stopwatch.h"
#include "runtime/sim/plant_from_bake.h"
#include "runtime/sim/state_hash.h"
#include "runtime/wind/wind_forces.h"

namespace liana {
namespace {

constexpr double kGroundHeight = 0;  // m: the ground is level, as the renderer draws it

std::vector<std::unique_ptr<SdfObstacle>> obstacles_of(const Scene& scene) {
  std::vector<std::unique_ptr<SdfObstacle>> obstacles;
  for (const SceneObstacle& obstacle : scene.obstacles) {
    try {
      obstacles.push_back(std::make_unique<SdfObstacle>(obstacle.mesh));
    } catch (const Error& error) {
      throw Error(error.kind,
                  fmt::format("{}: obstacle '{}': {}", scene.file.string(), obstacle.name, error.what()),
                  error.hint);
    }
  }
  return obstacles;
}

std::vector<const SdfObstacle*> pointers_to(const std::vector<std::unique_ptr<SdfObstacle>>& obstacles) {
  std::vector<const SdfObstacle*> pointers;
  for (const auto& obstacle : obstacles) pointers.push_back(obstacle.get());
  return pointers;
}

GustParameters gusts(const Scene& scene) {
  GustParameters gusts;
  gusts.mean = scene.wind.velocity;
  gusts.intensity = scene.wind.gust;
  gusts.peak_frequency = 1 / scene.wind.gust_period;
  gusts.seed = scene.seed;
  return gusts;
}

}  // namespace

World::World(const Scene& scene, unsigned threads)
    : scene_(scene),
      threads_(threads),
      obstacles_(obstacles_of(scene)),
      solids_(pointers_to(obstacles_)),
      open_wind_(gusts(scene)),
      wind_(open_wind_, solids_, kGroundHeight) {
  for (const ScenePlant& entry : scene.plants) add_baked(entry);
  for (size_t i = 0; i < scene.climbers.size(); ++i) add_climber(scene.climbers[i], scene.seed + i);
}

void World::add_baked(const ScenePlant& entry) {
  auto inhabitant = std::make_unique<Inhabitant>();
  PlacementOptions placement;
  placement.position = entry.position;
  placement.yaw = entry.yaw;
  placement.gravity = scene_.gravity;
  placement.scheme.dt = scene_.time_step;
  CalibrationReport calibration;
  const Bake bake = read_bake(entry.bake);
  inhabitant->plant = make_plant(bake, placement, &calibration);
  const std::string& name = inhabitant->plant.name;
  if (!calibration.note.empty()) notes_.push_back(name + ": " + calibration.note);
  if (!calibration.out_of_range.empty())
    notes_.push_back(fmt::format("{}: {} of {} domains are too fast for a step of {} s and move as near as it can",
                                 name, calibration.out_of_range.size(), calibration.branches, scene_.time_step));
  inhabitant->look = plant_look(bake.law.species);
  inhabitants_.push_back(std::move(inhabitant));
}

void World::add_climber(const SceneClimber& entry, uint64_t seed) {
  auto inhabitant = std::make_unique<Inhabitant>();
  const SpeciesLaw law = entry.bake.empty() ? read_species(entry.species) : read_bake(entry.bake).law;
  inhabitant->plant.name = law.species;
  inhabitant->plant.scheme.dt = scene_.time_step;
  ClimberParameters parameters;
  parameters.max_particles = entry.max_particles;
  parameters.gravity = scene_.gravity;
  inhabitant->climber.emplace(parameters, law, entry.position, seed);
  inhabitant->growth_speed = entry.growth_speed;
  inhabitant->look = plant_look(law.species);
  inhabitants_.push_back(std::move(inhabitant));
}

void World::step() {
  const PhaseSeconds before = report().seconds;
  parallel_for(inhabitants_.size(), threads_, [&](size_t i, unsigned) { step_inhabitant(i); });
  ++steps_;
  const PhaseSeconds after = report().seconds;
  last_step_ = {after.growth - before.growth, after.collision - before.collision, after.physics - before.physics};
}

void World::step_inhabitant(size_t index) {
  Inhabitant& self = *inhabitants_[index];
  WorldReport& report = self.report;
  self.springs.clear();
  report.seconds.growth += timed([&] {
    if (self.climber) self.climber->grow(self.plant, solids_, scene_.to_sun, self.growth_speed * scene_.time_step);
  });
  const Stopwatch watch;
  if (scene_.wind.velocity.norm() > 0) add_wind(self.plant, wind_, time(), {}, self.springs);
  if (grabbed_ && grabbed_->plant == index) self.springs.push_back(grabbed_->spring);
  const ContactStepReport done = self.stepper.step(self.plant, {solids_, kGroundHeight}, {}, self.springs,
                                                   {.dt = scene_.time_step, .gravity = scene_.gravity});
  report.max_penetration = std::max(report.max_penetration, done.contacts.max_penetration);
  report.contact_passes += static_cast<size_t>(done.passes - 1);
  report.redone_steps += done.step.redone > 0;
  report.reseated_joints += static_cast<size_t>(done.step.reseated);
  report.lost_steps += !done.step.finite;
  report.seconds.collision += done.collision_seconds;
  report.seconds.physics += watch.seconds() - done.collision_seconds;
}

void World::draw(DrawScene& scene) const { add_to(scene, false); }

DrawScene World::drawing(bool names) const {
  DrawScene scene;
  add_to(scene, names);
  return scene;
}

void World::add_to(DrawScene& scene, bool names) const {
  for (const auto& inhabitant : inhabitants_)
    add_plant(inhabitant->plant, inhabitant->look, {.names = names}, scene);
  for (const SceneObstacle& obstacle : scene_.obstacles)
    scene.meshes.push_back({obstacle.mesh, obstacle.color, obstacle.bricks, obstacle.name});
  scene.to_sun = scene_.to_sun.normalized();
}

Camera World::camera() const {
  Camera camera;
  if (scene_.camera) {
    const Vec3 back = scene_.camera->eye - scene_.camera->target;
    camera.pivot = scene_.camera->target;
    camera.distance = back.norm();
    camera.azimuth = std::atan2(back.x(), back.z());
    camera.elevation = std::asin(back.y() / back.norm());
    camera.field_of_view = scene_.camera->vertical_angle;
  } else {
    camera.frame(bounding_box(drawing()), 16.0 / 9);
  }
  return camera;
}

void World::set_grab(size_t plant, const WorldSpring& spring) { grabbed_ = Grab{plant, spring}; }

WorldReport World::report() const {
  WorldReport total;
  total.steps = steps_;
  for (const auto& inhabitant : inhabitants_) {
    const WorldReport& own = inhabitant->report;
    total.particles += inhabitant->plant.particles.size();
    total.anchors += inhabitant->plant.anchors.size();
    total.max_penetration = std::max(total.max_penetration, own.max_penetration);
    total.redone_steps += own.redone_steps;
    total.contact_passes += own.contact_passes;
    total.reseated_joints += own.reseated_joints;
    total.lost_steps += own.lost_steps;
    total.seconds.growth += own.seconds.growth;
    total.seconds.collision += own.seconds.collision;
    total.seconds.physics += own.seconds.physics;
  }
  return total;
}

SimulationStats World::stats() const {
  const WorldReport now = report();
  return {.time = time(),
          .steps = steps_,
          .particles = now.particles,
          .anchors = now.anchors,
          .growth_ms = 1e3 * last_step_.growth,
          .collision_ms = 1e3 * last_step_.collision,
          .physics_ms = 1e3 * last_step_.physics,
          .redone_steps = now.redone_steps};
}

uint64_t World::state_hash() const {
  uint64_t hash = 0;
  for (const auto& inhabitant : inhabitants_) hash = liana::state_hash(inhabitant->plant, hash);
  return hash;
}

}  // namespace liana
