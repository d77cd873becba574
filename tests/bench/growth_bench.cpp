// A climber on a wall in wind: what growth, collision and physics cost a step; and what the field of an
// obstacle costs.
#include <benchmark/benchmark.h>

#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/wind/field/sheltered_wind.h"
#include "runtime/wind/field/steady_gust_wind.h"
#include "tests/support/scenes/climber_scene.h"

namespace liana {
namespace {

void climber(benchmark::State& state) {
  const double seconds = static_cast<double>(state.range(0));
  for (auto _ : state) {
    ClimberScene scene;
    const SteadyGustWind open;
    const ShelteredWind wind(open, {&scene.wall}, 0.0);
    scene.run(seconds, &wind);
    const double per_step = 1e3 * scene.plant.scheme.dt / seconds;
    state.counters["particles"] = static_cast<double>(scene.plant.particles.size());
    state.counters["growth_ms"] = scene.seconds.growth * per_step;
    state.counters["collision_ms"] = scene.seconds.collision * per_step;
    state.counters["wind_ms"] = scene.seconds.wind * per_step;
    state.counters["physics_ms"] = (scene.seconds.physics - scene.seconds.collision) * per_step;
    state.counters["deepest_mm"] = 1e3 * scene.max_penetration;
  }
}
BENCHMARK(climber)->Arg(20)->Arg(60)->Iterations(1)->Unit(benchmark::kMillisecond);

void sdf_fill(benchmark::State& state) {
  const Mesh mesh = box_mesh({-2.5, 0, -0.2}, {2.5, 3, 0});
  for (auto _ : state) benchmark::DoNotOptimize(SdfObstacle(mesh, {.threads = 1}).bytes());
}
BENCHMARK(sdf_fill)->Unit(benchmark::kMillisecond);

std::vector<Vec3> points_at_the_wall() {
  Random random(1, "bench points");
  std::vector<Vec3> points;
  for (int i = 0; i < 10000; ++i)
    points.emplace_back(random.uniform(-2, 2), random.uniform(0.2, 2.8), random.uniform(-0.02, 0.06));
  return points;
}

void sdf_sample(benchmark::State& state) {
  const SdfObstacle wall(box_mesh({-2.5, 0, -0.2}, {2.5, 3, 0}));
  const std::vector<Vec3> points = points_at_the_wall();
  size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(wall.sample(points[i++ % points.size()]).distance);
}
BENCHMARK(sdf_sample);

void closest_point(benchmark::State& state) {
  const SdfObstacle wall(box_mesh({-2.5, 0, -0.2}, {2.5, 3, 0}));
  const std::vector<Vec3> points = points_at_the_wall();
  size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(wall.closest_point(points[i++ % points.size()]).distance);
}
BENCHMARK(closest_point);

}  // namespace
}  // namespace liana
