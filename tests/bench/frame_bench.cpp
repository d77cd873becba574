// Whole frames of a scene on two cores: growth, collision and physics, with and without air particles.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "materials/bake/bake_file.h"
#include "mesher/base/stopwatch.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/world/world.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

/// Ivies that stand side by side before a long wall, each with its share of `particles`, in a breeze.
Scene ivies(size_t count, size_t particles) {
  constexpr double kApart = 3;
  Scene scene;
  scene.wind.velocity = {2.5, 0, 0.8};
  const double reach = kApart * static_cast<double>(count) / 2;
  scene.obstacles.push_back(
      {"wall", box_mesh({-reach, 0, -0.25}, {reach, 3, 0}), Vec3::Zero(), false, {}, {}, {}});
  for (size_t i = 0; i < count; ++i)
    scene.climbers.push_back({.bake = {},
                              .species = "ivy",
                              .position = {kApart * (static_cast<double>(i) + 0.5) - reach, 0, 0.1},
                              .growth_speed = 2,
                              .max_particles = particles / count});
  return scene;
}

void grow_and_time(World& world, size_t wanted, benchmark::State& state) {
  constexpr int kMostSteps = 6000, kFrames = 200;
  for (int i = 0; i < kMostSteps && world.report().particles < wanted; ++i) world.step();
  const PhaseSeconds before = world.report().seconds;
  double longest = 0;
  const Stopwatch watch;
  for (int i = 0; i < kFrames; ++i) longest = std::max(longest, timed([&] { world.step(); }));
  const double seconds = watch.seconds();
  const WorldReport after = world.report();
  const auto per_frame = [&](double spent) { return 1e3 * spent / kFrames; };
  state.counters["particles"] = static_cast<double>(after.particles);
  state.counters["frame_ms"] = per_frame(seconds);
  state.counters["longest_ms"] = 1e3 * longest;
  // Summed over threads, but for the air.
  state.counters["growth_ms"] = per_frame(after.seconds.growth - before.growth);
  state.counters["collision_ms"] = per_frame(after.seconds.collision - before.collision);
  state.counters["physics_ms"] = per_frame(after.seconds.physics - before.physics);
  state.counters["touching_ms"] = per_frame(after.seconds.touching - before.touching);
  state.counters["touches"] = static_cast<double>(after.plant_contacts);
  state.counters["air_ms"] = per_frame(after.seconds.wind - before.wind);
  if (after.air) state.counters["air"] = static_cast<double>(after.air->particles);
}

void frame_of_growing_ivies(benchmark::State& state) {
  for (auto _ : state) {
    Scene scene = ivies(8, 25000);
    scene.plant_contacts = state.range(0) > 0;
    World world(with_united_solids(scene), 2);
    grow_and_time(world, 24900, state);
  }
}
BENCHMARK(frame_of_growing_ivies)
    ->ArgName("touching")
    ->Arg(0)
    ->Arg(1)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void frame_of_ivies_in_air(benchmark::State& state) {
  for (auto _ : state) {
    Scene scene = ivies(4, 10000);
    SphWindParameters air;
    air.low = {-6.5, 0, 0}, air.high = {6.5, 3, 2.4};
    air.spacing = 0.2;
    air.max_particles = 10000;
    air.threads = 2;
    air.emitters.push_back(
        {.shape = EmitterParameters::Shape::Box, .center = {-6.3, 1.5, 1.2}, .width = 2.2, .height = 2.8});
    scene.wind.air = air;
    World world(with_united_solids(scene), 2);
    grow_and_time(world, 9900, state);
  }
}
BENCHMARK(frame_of_ivies_in_air)->Iterations(1)->Unit(benchmark::kMillisecond);

/// Saving and loading all of a world's state: snapshots for undo.
void state_of_a_world(benchmark::State& state) {
  const ScratchFolder folder;
  write_bake(test::synthetic_bake({.branches = 24, .twigs = 6, .leaves = 6}), folder / "tree.bake");
  Scene scene;
  for (int i = 0; i < 12; ++i)
    scene.plants.push_back({folder / "tree.bake", Vec3(2.0 * i, 0, 0), 0.3 * i, 0.5});
  scene.wind.velocity = {4, 0, 1};
  World world(scene, 2);
  for (int i = 0; i < 20; ++i) world.step();
  WorldState saved;
  for (auto _ : state) {
    if (state.range(0) > 0)
      world.load(saved = world.save());
    else
      world.save(saved);
  }
  state.counters["particles"] = static_cast<double>(world.report().particles);
  state.counters["megabytes"] = 1e-6 * static_cast<double>(saved.bytes().size());
}
BENCHMARK(state_of_a_world)->ArgName("and_load")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace liana
