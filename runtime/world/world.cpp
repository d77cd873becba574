#include "runtime/world/world.h"

#include <fmt/core.h>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "mesher/base/parallel.h"
#include "mesher/base/stopwatch.h"
#include "runtime/sim/model/grab_spring.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/world/world_drawing.h"

namespace liana {
namespace {

constexpr double kGroundHeight = 0;  // m: the ground is level, as the renderer draws it

std::vector<std::string> notes_of(const Scene& scene) {
  return scene.solids ? scene.solids->notes : std::vector<std::string>();
}

}  // namespace

World::World(Scene scene, unsigned threads)
    : scene_(std::move(scene)),
      notes_(notes_of(scene_)),
      threads_(threads > 0 ? threads : default_thread_count()),
      obstacles_(scene_),
      garden_(scene_, notes_),
      weather_(scene_, obstacles_.standing(), obstacles_.moving(), kGroundHeight, threads),
      script_(scene_, garden_),
      severing_(scene_.detached),
      workspaces_(threads_),
      identity_(identity_of(scene_, garden_)) {
  start_threads(threads_);
}

void World::step() {
  const PhaseSeconds before = report().seconds;
  const double now = time(), dt = scene_.time_step;
  begin_acts();
  garden_.take_removals();
  grabs_.lead(scene_.grabs, now, dt, garden_);
  obstacles_.move(now, now + dt);

  const auto prepare = [&](size_t plant) {
    garden_[plant].springs.clear();
    script_.strike(plant, garden_[plant].plant, steps_);
    garden_.grow(plant, obstacles_.all(), scene_.to_sun, dt);
  };
  // The air and other plants meet all plants at once, between their growth and their steps.
  const bool meet = scene_.plant_contacts || weather_.has_air();
  if (meet) parallel_for(garden_.size(), threads_, [&](size_t plant, unsigned) { prepare(plant); });
  if (scene_.plant_contacts) garden_.touch();
  if (weather_.has_air()) weather_.advance(garden_.in_wind(), now, dt);

  // Threads that no other large plant needs share one.
  const auto large = static_cast<unsigned>(garden_.large_ones());
  const unsigned share = std::max(1u, threads_ / std::max(1u, large));
  parallel_for(garden_.size(), threads_, [&](size_t plant, unsigned worker) {
    if (!meet) prepare(plant);
    move(plant, share, workspaces_[worker]);
  });
  StepWorkspace::level(workspaces_);
  if (weather_.has_air()) weather_.react(garden_.in_wind());

  severing_.break_overloaded(garden_, [&](const Detachment& cut) { follow(cut, steps_ + 1); });
  severing_.remove_parts(garden_, grabs_, dt);
  ++steps_;
  last_step_ = report().seconds - before;
}

void World::begin_acts() {
  const auto begin = [&](double when, const ScenePoint& where, const char* what, const auto& act) {
    if (!script_.is_now(when, steps_)) return;
    if (const auto point = script_.find(where, garden_))
      act(*point);
    else
      notes_.push_back(fmt::format("at {:.2f} s: nothing was left to {}", time(), what));
  };
  for (const SceneCut& entry : scene_.cuts)
    begin(entry.time, entry.where, "cut", [&](const PlantPoint& point) { cut(point.plant, point.particle); });
  for (const SceneGrab& entry : scene_.grabs)
    begin(entry.time, entry.where, "grab", [&](const PlantPoint& point) {
      const WorldSpring spring = grab_spring(garden_[point.plant].plant, point.particle, Vec3::Zero(),
                                             scene_.gravity, scene_.time_step, entry.strength);
      grabs_.begin(static_cast<size_t>(&entry - scene_.grabs.data()), point.plant, spring, spring.target);
    });
}

void World::move(size_t index, unsigned threads, StepWorkspace& workspace) {
  PlantInstance& self = garden_[index];
  if (self.plant.particles.empty() || self.asleep()) return;
  const Stopwatch watch;
  weather_.add_to(index, self.plant, time(), self.springs, self.wrenches);
  grabs_.add_to(index, self.springs);
  const ContactStepReport done =
      self.stepper.step(self.plant, {obstacles_.all(), kGroundHeight}, self.wrenches, self.springs,
                        {.dt = scene_.time_step, .gravity = scene_.gravity, .threads = threads}, workspace);
  self.report.note(done);
  severing_.look_for_fractures(self);
  severing_.let_rest(self, scene_.time_step);
  self.report.physics_seconds += watch.seconds() - done.collision_seconds;
}

void World::cut(size_t plant, ParticleId particle) {
  require(plant < garden_.size() && particle.index() < garden_[plant].plant.particles.size(),
          "World::cut: no such particle");
  follow(severing_.cut(garden_, plant, particle), steps_);
}

void World::follow(const Detachment& cut, size_t next_step) {
  grabs_.follow(cut);
  script_.follow(cut, garden_, next_step, notes_);
}

void World::draw(DrawScene& scene) const {
  add_world(*this, false, scene);
}

WorldReport World::report() const {
  WorldReport report;
  severing_.add_to(report);
  garden_.add_to(report);
  report.steps = steps_;
  report.seconds.growth = report.growth_seconds;
  report.seconds.collision = report.collision_seconds;
  report.seconds.physics = report.physics_seconds;
  report.seconds.wind = weather_.seconds();
  if (weather_.has_air()) report.air = weather_.air()->report();
  return report;
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
  for (size_t i = 0; i < garden_.size(); ++i) hash = liana::state_hash(garden_[i].plant, hash);
  if (weather_.has_air()) {
    const SphAir& air = weather_.air()->air();
    hash = hash_bytes(air.states(), air.size() * sizeof(AirState), hash);
  }
  return hash;
}

void World::save(WorldState& into) const {
  // An archive that writes leaves what it walks through as it is.
  auto& self = const_cast<World&>(*this);
  into.write(identity_, [&](StateWriter& writer) {
    for (const SdfObstacle* solid : obstacles_.all()) writer.know(solid);
    writer(self);
  });
}

WorldState World::save() const {
  WorldState state;
  save(state);
  return state;
}

void World::load(const WorldState& state) {
  state.read(identity_, [&](StateReader& reader) {
    for (const SdfObstacle* solid : obstacles_.all()) reader.know(solid);
    reader(*this);
  });
}

}  // namespace liana
