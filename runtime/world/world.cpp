#include "runtime/world/world.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "materials/bake/bake_file.h"
#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "mesher/base/nearest_word.h"
#include "mesher/base/parallel.h"
#include "mesher/base/stopwatch.h"
#include "runtime/obstacles/shells.h"
#include "runtime/picture/air_drawing.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/world/touching_solids.h"

namespace liana {
namespace {

constexpr size_t kLarge = 1000;         // particles of a plant whose step is worth sharing
constexpr size_t kMostBreaksAStep = 8;  // of one plant; what remains overloaded breaks in the next
constexpr double kGroundHeight = 0;     // m: the ground is level, as the renderer draws it

/// Those that move first; `owner`: for each of these, which obstacle of the scene it belongs to.
std::vector<std::unique_ptr<SdfObstacle>> obstacles_of(const Scene& scene, std::vector<size_t>& owner,
                                                       std::vector<std::string>& notes) {
  std::vector<std::unique_ptr<SdfObstacle>> obstacles, sheets;
  std::vector<StandingSolid> standing;
  for (const SceneObstacle& obstacle : scene.obstacles) {
    try {
      const Pieces pieces = pieces_of(obstacle.mesh);
      const double thickness = obstacle.thickness.value_or(kSheetThickness);
      if (pieces.sheet_count > 0 && !obstacle.thickness)
        notes.push_back(fmt::format(
            "obstacle '{}': {} of its {} pieces have no inside and count as sheets {} mm thick "
            "('thickness' sets it)",
            obstacle.name, pieces.sheet_count, pieces.solids.size() + pieces.sheet_count, 1e3 * thickness));
      for (const Mesh& solid : pieces.solids) {
        if (!obstacle.motion) {
          standing.push_back({solid, obstacle.material});
          continue;
        }
        owner.push_back(&obstacle - scene.obstacles.data());
        obstacles.push_back(std::make_unique<SdfObstacle>(solid));
        obstacles.back()->material = obstacle.material;
      }
      if (pieces.sheet_count == 0) continue;
      auto sheet = std::make_unique<SdfObstacle>(pieces.sheets, SdfOptions{.sheet = thickness});
      sheet->material = obstacle.material;
      if (obstacle.motion) owner.push_back(&obstacle - scene.obstacles.data());
      (obstacle.motion ? obstacles : sheets).push_back(std::move(sheet));
    } catch (const Error& error) {
      throw Error(error.kind,
                  fmt::format("{}: obstacle '{}': {}", scene.file.string(), obstacle.name, error.what()),
                  error.hint);
    }
  }
  unite_touching(standing);
  for (const StandingSolid& solid : standing) {
    obstacles.push_back(std::make_unique<SdfObstacle>(solid.mesh, SdfOptions{.voxel = solid.voxel}));
    obstacles.back()->material = solid.material;
  }
  for (auto& sheet : sheets) obstacles.push_back(std::move(sheet));
  return obstacles;
}

std::vector<const SdfObstacle*> pointers_to(const std::vector<std::unique_ptr<SdfObstacle>>& obstacles) {
  std::vector<const SdfObstacle*> pointers;
  for (const auto& obstacle : obstacles) pointers.push_back(obstacle.get());
  return pointers;
}

}  // namespace

void World::add(const WorldReport& own, WorldReport& total) {
  total.max_penetration = std::max(total.max_penetration, own.max_penetration);
  total.redone_steps += own.redone_steps;
  total.contact_passes += own.contact_passes;
  total.reseated_joints += own.reseated_joints;
  total.lost_steps += own.lost_steps;
  total.seconds.growth += own.seconds.growth;
  total.seconds.collision += own.seconds.collision;
  total.seconds.physics += own.seconds.physics;
}

World::World(const Scene& scene, unsigned threads)
    : scene_(scene),
      threads_(threads),
      obstacles_(obstacles_of(scene, obstacle_of_, notes_)),
      solids_(pointers_to(obstacles_)),
      touching_({.material = scene.plant_material, .weights = scene.contact_weights}),
      wind_(scene, those_that_move(false), those_that_move(true), kGroundHeight, threads),
      workspaces_(threads > 0 ? threads : default_thread_count()) {
  start_threads(threads);
  for (const ScenePlant& entry : scene.plants) add_baked(entry);
  for (size_t i = 0; i < scene.climbers.size(); ++i) add_climber(scene.climbers[i], scene.seed + i);
  for (const SceneCut& cut : scene_.cuts) check_point(cut.where, "[[cut]]");
  for (const SceneGrab& grab : scene_.grabs) check_point(grab.where, "[[grab]]");
}

void World::add_baked(const ScenePlant& entry) {
  auto inhabitant = std::make_unique<Inhabitant>(ContactOptions{.weights = scene_.contact_weights});
  PlacementOptions placement;
  placement.position = entry.position;
  placement.yaw = entry.yaw;
  placement.gravity = scene_.gravity;
  placement.scheme.dt = scene_.time_step;
  placement.scheme.solver = scene_.solver;
  CalibrationReport calibration;
  const Bake bake = read_bake(entry.bake);
  inhabitant->plant = make_plant(bake, placement, &calibration);
  const std::string& name = inhabitant->plant.name;
  if (!calibration.note.empty()) notes_.push_back(name + ": " + calibration.note);
  if (!calibration.out_of_range.empty())
    notes_.push_back(
        fmt::format("{}: {} of {} domains are too fast for a step of {} s and move as near as it can", name,
                    calibration.out_of_range.size(), calibration.branches, scene_.time_step));
  inhabitant->look = plant_look(bake.law.species);
  for (const BakedDomain& domain : bake.domains) inhabitant->domains.push_back(domain.name);
  const size_t unknown = set_strengths(inhabitant->plant, bake.law, entry.breaking);
  if (entry.breaking > 0 && unknown > 0)
    notes_.push_back(
        fmt::format("{}: {} branches and leaves have no modulus of rupture in their law: they do not break",
                    name, unknown));
  inhabitants_.push_back(std::move(inhabitant));
  for (const ScenePluck& pluck : scene_.plucks)
    if (pluck.plant + 1 == inhabitants_.size()) add_pluck(pluck, bake);
}

void World::add_pluck(const ScenePluck& entry, const Bake& bake) {
  const Plant& plant = inhabitants_.back()->plant;
  std::optional<BranchId> found;
  std::vector<std::string> names;
  for (size_t i = 0; i < plant.branches.size(); ++i) {
    const DomainId domain = plant.branches[i].domain;
    if (!domain.valid()) continue;
    names.push_back(bake.domains[domain.index()].name);
    if (!found && (entry.domain == names.back() || entry.domain == "#" + std::to_string(domain.index())))
      found = BranchId(i);
  }
  if (!found)
    throw Error(Error::Kind::Input,
                fmt::format("{}: [[pluck]] names '{}', but '{}' has no such branch or leaf",
                            scene_.file.string(), entry.domain, plant.name),
                fmt::format("did you mean '{}'?", nearest_word(entry.domain, names)));
  plucks_.push_back(
      {entry.plant, *found, static_cast<size_t>(std::lround(entry.time / scene_.time_step)), entry.velocity});
}

void World::pluck(size_t index) {
  Plant& plant = inhabitants_[index]->plant;
  for (const Pluck& pluck : plucks_) {
    if (pluck.plant != index || pluck.step != steps_) continue;
    const Branch& branch = plant.branches[pluck.branch.index()];
    double length = 0, before = 0;
    for (const ParticleId id : branch.particles) length += 2 * plant.particles[id.index()].half_length;
    for (const ParticleId id : branch.particles) {
      Motion& motion = plant.motion[id.index()];
      const double half = plant.particles[id.index()].half_length, way = (before + half) / length;
      before += 2 * half;
      motion.velocity += way * way * pluck.velocity;
      // The slope of that velocity along the branch turns the particle.
      const Vec3 axis = motion.orientation * Vec3::UnitY();
      motion.angular_velocity += axis.cross(2 * way / length * pluck.velocity);
    }
  }
}

void World::add_climber(const SceneClimber& entry, uint64_t seed) {
  auto inhabitant = std::make_unique<Inhabitant>(ContactOptions{.weights = scene_.contact_weights});
  SpeciesLaw law = entry.bake.empty() ? read_species(entry.species) : read_bake(entry.bake).law;
  inhabitant->plant.name = law.species;
  inhabitant->plant.scheme.dt = scene_.time_step;
  inhabitant->plant.scheme.solver = scene_.solver;
  ClimberParameters parameters;
  parameters.max_particles = entry.max_particles;
  parameters.gravity = scene_.gravity;
  parameters.first_shoots = entry.first_shoots;
  parameters.longest_free = entry.longest_free;
  parameters.weight_grown_in = entry.weight_grown_in;
  law.default_material.youngs_modulus *= entry.stiffness;
  for (auto& [group, numbers] : law.groups) numbers.reference_frequency *= std::sqrt(entry.stiffness);
  if (entry.breaking > 0) {
    parameters.strength = modulus_of_rupture(law, "level0") / entry.breaking;
    parameters.leaf_strength = modulus_of_rupture(law, "leaf") / entry.breaking;
    if (parameters.strength == 0)
      notes_.push_back(law.species + ": its law has no modulus of rupture: it does not break");
  }
  inhabitant->climber.emplace(parameters, law, entry.position, seed);
  inhabitant->growth_speed = entry.growth_speed;
  inhabitant->look = plant_look(law.species);
  inhabitants_.push_back(std::move(inhabitant));
}

std::vector<const SdfObstacle*> World::those_that_move(bool move) const {
  std::vector<const SdfObstacle*> those;
  for (size_t i = 0; i < solids_.size(); ++i)
    if ((i < obstacle_of_.size()) == move) those.push_back(solids_[i]);
  return those;
}

void World::move_obstacles() {
  for (size_t i = 0; i < obstacle_of_.size(); ++i)
    obstacles_[i]->place(
        scene_.obstacles[obstacle_of_[i]].motion->between(time(), time() + scene_.time_step));
}

void World::step() {
  const PhaseSeconds before = report().seconds;
  start_events();
  lead_grabs();
  move_obstacles();
  const auto prepare = [&](size_t i) {
    inhabitants_[i]->springs.clear();
    pluck(i);
    grow(*inhabitants_[i]);
  };
  // The air and other plants meet all plants at once, between their growth and their steps.
  const bool meet = scene_.plant_contacts || wind_.has_air();
  if (meet) parallel_for(inhabitants_.size(), threads_, [&](size_t i, unsigned) { prepare(i); });
  if (scene_.plant_contacts) {
    all_plants_.clear();
    all_springs_.clear();
    for (const auto& inhabitant : inhabitants_) {
      all_plants_.push_back(&inhabitant->plant);
      all_springs_.push_back(&inhabitant->springs);
    }
    touching_seconds_ += timed([&] { touched_ = touching_.gather(all_plants_, all_springs_); });
    max_overlap_ = std::max(max_overlap_, touched_.max_overlap);
  }
  if (wind_.has_air()) {
    in_wind_.clear();
    for (const auto& inhabitant : inhabitants_) in_wind_.push_back({&inhabitant->plant, inhabitant->growing});
    wind_.advance(in_wind_, time(), scene_.time_step);
  }
  // Threads that no other large plant needs share one.
  const auto large =
      static_cast<unsigned>(std::count_if(inhabitants_.begin(), inhabitants_.end(), [](const auto& i) {
        return i->plant.particles.size() >= kLarge && !i->asleep();
      }));
  const unsigned all = threads_ > 0 ? threads_ : default_thread_count();
  const unsigned share = std::max(1u, all / std::max(1u, large));
  parallel_for(inhabitants_.size(), threads_, [&](size_t i, unsigned worker) {
    if (!meet) prepare(i);
    step_inhabitant(i, share, workspaces_[worker]);
  });
  StepWorkspace::level(workspaces_);
  if (wind_.has_air()) wind_.react(in_wind_);
  break_what_is_overloaded();
  remove_parts();
  ++steps_;
  const PhaseSeconds after = report().seconds;
  last_step_ = {after.growth - before.growth, after.collision - before.collision,
                after.physics - before.physics, after.touching - before.touching, after.wind - before.wind};
}

void World::grow(Inhabitant& self) {
  self.report.seconds.growth += timed([&] {
    if (!self.climber) return;
    self.climber->grow(self.plant, solids_, scene_.to_sun, self.growth_speed * scene_.time_step);
    self.climber->mark_growing(self.plant, self.growing);
  });
}

void World::step_inhabitant(size_t index, unsigned threads, StepWorkspace& workspace) {
  Inhabitant& self = *inhabitants_[index];
  WorldReport& report = self.report;
  if (self.plant.particles.empty() || self.asleep()) return;
  const Stopwatch watch;
  wind_.add_to(index, self.plant, time(), self.springs, self.wrenches);
  if (grabbed_ && grabbed_->plant == index) self.springs.push_back(grabbed_->spring);
  for (const ScriptedGrab& grab : scripted_)
    if (grab.plant == index) self.springs.push_back(grab.spring);
  const ContactStepReport done =
      self.stepper.step(self.plant, {solids_, kGroundHeight}, self.wrenches, self.springs,
                        {.dt = scene_.time_step, .gravity = scene_.gravity, .threads = threads}, workspace);
  report.contacts = done.contacts.contacts;
  report.max_penetration = std::max(report.max_penetration, done.contacts.max_penetration);
  report.contact_passes += static_cast<size_t>(done.passes - 1);
  report.redone_steps += done.step.redone > 0;
  report.reseated_joints += static_cast<size_t>(done.step.projected);
  report.lost_steps += !done.step.finite;
  report.seconds.collision += done.collision_seconds;
  find_fractures(self.plant, kMostBreaksAStep, self.fractures);
  if (self.fallen) let_rest(self);
  report.seconds.physics += watch.seconds() - done.collision_seconds;
}

void World::draw(DrawScene& scene) const {
  add_to(scene, false);
}

DrawScene World::drawing(bool names) const {
  DrawScene scene;
  add_to(scene, names);
  return scene;
}

void World::add_to(DrawScene& scene, bool names) const {
  for (const auto& inhabitant : inhabitants_)
    add_plant(inhabitant->plant, inhabitant->look, {.names = names}, scene);
  for (const SceneObstacle& obstacle : scene_.obstacles) {
    scene.meshes.push_back({obstacle.mesh, obstacle.color, obstacle.bricks, obstacle.name});
    if (!obstacle.motion) continue;
    const ObstaclePose pose = obstacle.motion->between(time(), time());
    for (Vec3& p : scene.meshes.back().mesh.positions) p = pose.rotation * p + pose.position;
  }
  scene.to_sun = scene_.to_sun.normalized();
  if (wind_.has_air() && scene_.wind.show_air) add_air(wind_.air()->air(), scene);
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

void World::set_grab(size_t plant, const WorldSpring& spring) {
  const bool same = grabbed_ && grabbed_->asked_plant == plant && grabbed_->asked_particle == spring.particle;
  if (!same) grabbed_ = Grab{plant, spring, plant, spring.particle};
  const ParticleId particle = grabbed_->spring.particle;
  grabbed_->spring = spring;
  grabbed_->spring.particle = particle;
  inhabitants_[grabbed_->plant]->still_for = 0;  // wakes it
}

WorldReport World::report() const {
  WorldReport total = departed_;
  total.steps = steps_;
  for (const auto& inhabitant : inhabitants_) {
    total.particles += inhabitant->plant.particles.size();
    total.anchors += inhabitant->plant.anchors.size();
    total.contacts += inhabitant->report.contacts;
    total.fallen += inhabitant->fallen;
    total.asleep += inhabitant->asleep();
    add(inhabitant->report, total);
  }
  total.plant_contacts = touched_.contacts;
  total.grown_together = touched_.exempt;
  total.max_overlap = max_overlap_;
  total.seconds.touching = touching_seconds_;
  total.broken = broken_, total.shed = shed_, total.cut = cut_, total.removed = removed_;
  total.seconds.wind = wind_.seconds();
  if (wind_.has_air()) total.air = wind_.air()->report();
  return total;
}

SimulationStats World::stats() const {
  const WorldReport now = report();
  return {.time = time(),
          .steps = steps_,
          .particles = now.particles,
          .anchors = now.anchors,
          .growth_ms = 1e3 * last_step_.growth,
          .collision_ms = 1e3 * (last_step_.collision + last_step_.touching),
          .physics_ms = 1e3 * last_step_.physics,
          .wind_ms = 1e3 * last_step_.wind,
          .redone_steps = now.redone_steps};
}

uint64_t World::state_hash() const {
  uint64_t hash = 0;
  for (const auto& inhabitant : inhabitants_) hash = liana::state_hash(inhabitant->plant, hash);
  if (wind_.has_air()) {
    const SphAir& air = wind_.air()->air();
    hash = hash_bytes(air.states(), air.size() * sizeof(AirState), hash);
  }
  return hash;
}

}  // namespace liana
