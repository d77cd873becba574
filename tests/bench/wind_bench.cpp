// Air particles: particle-steps a second, a whole frame of them, and their meeting with plants.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/wind/air/plant_coupling.h"
#include "runtime/wind/air/sph_kernels.h"
#include "runtime/wind/air/sph_wind.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A cube of disordered air that holds together: it moves through nothing, at rest density.
AirOptions air_options(size_t count, unsigned threads, bool portable = false) {
  const int n = static_cast<int>(std::cbrt(static_cast<double>(count)) + 0.5);
  AirOptions options;
  options.low = Vec3::Zero(), options.high = Vec3::Constant(0.1 * n + 2);
  options.spacing = 0.1;
  options.viscosity = 0.02;
  options.capacity = static_cast<size_t>(n) * n * n;
  options.threads = threads;
  options.portable = portable;
  return options;
}

void fill(SphAir& air) {
  const int n = static_cast<int>(std::cbrt(static_cast<double>(air.options().capacity)) + 0.5);
  Random random(1, "bench");
  const auto jitter = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z)
        air.add(Vec3::Constant(1) + 0.1 * Vec3(x, y, z) + 0.01 * jitter(), 0.1 * jitter());
}

void air_step(benchmark::State& state) {
  SphAir air(air_options(static_cast<size_t>(state.range(0)), static_cast<unsigned>(state.range(1))));
  fill(air);
  for (int i = 0; i < 5; ++i) air.step(air.longest_step());
  const double start = processor_seconds();
  size_t done = 0;
  for (auto _ : state) air.step(air.longest_step()), done += air.size();
  const double spent = processor_seconds() - start;
  state.counters["particles"] = static_cast<double>(air.size());
  state.counters["M_particle_steps_per_core_s"] = 1e-6 * static_cast<double>(done) / spent;
  state.counters["ns_per_particle_step"] = 1e9 * spent / static_cast<double>(done);
}
BENCHMARK(air_step)
    ->Args({5000, 1})
    ->Args({10000, 1})
    ->Args({20000, 1})
    ->Args({100000, 1})
    ->Args({10000, 2})
    ->Args({20000, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The same sums by cells of linked lists, one pair at a time: what the fast version is compared with.
void naive_air_step(benchmark::State& state) {
  SphAir air(air_options(static_cast<size_t>(state.range(0)), 1));
  fill(air);
  air.sort();
  const size_t n = air.size();
  const double h = air.support(), m = air.particle_mass();
  std::vector<Vec3> x, v, a(n);
  for (size_t i = 0; i < n; ++i) x.push_back(air.position(i)), v.push_back(air.velocity(i));
  std::vector<double> rho(n), p(n);
  const int side = static_cast<int>(air.options().high.x() / h) + 3;
  std::vector<int> head(static_cast<size_t>(side) * side * side), next(n);
  const auto cell = [&](const Vec3& place) -> Eigen::Vector3i {
    return (place / h).cast<int>() + Eigen::Vector3i::Ones();
  };
  const auto neighbours = [&](size_t i, const auto& visit) {
    const Eigen::Vector3i c = cell(x[i]);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int k = -1; k <= 1; ++k)
          for (int j = head[c.x() + k + side * (c.y() + y + side * (c.z() + z))]; j >= 0; j = next[j])
            if ((x[j] - x[i]).squaredNorm() < h * h) visit(static_cast<size_t>(j));
  };
  const double start = processor_seconds();
  size_t done = 0;
  for (auto _ : state) {
    std::fill(head.begin(), head.end(), -1);
    for (size_t i = 0; i < n; ++i) {
      const Eigen::Vector3i c = cell(x[i]);
      int& first = head[c.x() + side * (c.y() + side * c.z())];
      next[i] = first, first = static_cast<int>(i);
    }
    for (size_t i = 0; i < n; ++i) {
      rho[i] = 0;
      neighbours(i, [&](size_t j) {
        rho[i] += m * poly6_factor(h) * std::pow(h * h - (x[j] - x[i]).squaredNorm(), 3);
      });
      p[i] = 225 * std::max(0.0, rho[i] - 1.3);
    }
    for (size_t i = 0; i < n; ++i) {
      a[i] = Vec3::Zero();
      neighbours(i, [&](size_t j) {
        const Vec3 d = x[i] - x[j];
        const double r = d.norm();
        if (r == 0) return;
        const double share = m * spiky_factor(h) * (h - r) / (rho[i] * rho[j]);
        a[i] += share * ((p[i] + p[j]) / 2 * (h - r) / r * d - 0.02 * (v[i] - v[j]));
      });
    }
    benchmark::DoNotOptimize(a.data());
    done += n;
  }
  state.counters["ns_per_particle_step"] = 1e9 * (processor_seconds() - start) / static_cast<double>(done);
}
BENCHMARK(naive_air_step)->Arg(10000)->Unit(benchmark::kMillisecond);

/// A frame of 25 ms: a jet that fills its domain with so many particles, and ten thousand particles of plants
/// in it. Arguments: air particles, threads, plants' particles.
void wind_frame(benchmark::State& state) {
  const double spacing = 0.15, particles = static_cast<double>(state.range(0));
  const double side = 2.4, length = 2 * particles * std::pow(spacing, 3) / (side * side);  // more than room
  SphWindParameters parameters;
  parameters.spacing = spacing;
  parameters.low = {-0.2, 0, -side}, parameters.high = {length, 2 * side, side};
  parameters.max_particles = static_cast<size_t>(particles);
  parameters.threads = static_cast<unsigned>(state.range(1));
  EmitterParameters fan;
  fan.shape = EmitterParameters::Shape::Box;
  fan.center = {0, side, 0}, fan.direction = Vec3::UnitX(), fan.speed = 5;
  fan.width = fan.height = side;
  parameters.emitters = {fan};
  SphWind wind(parameters, {}, 0.0);

  std::vector<Plant> plants;
  std::vector<PlantInWind> in;
  for (size_t total = 0; total < static_cast<size_t>(state.range(2));
       total += plants.back().particles.size()) {
    PlacementOptions placement;
    placement.position = {0.5 + 0.4 * static_cast<double>(plants.size()), 0, 0};
    plants.push_back(make_plant(test::synthetic_bake({.branches = 12}), placement));
  }
  for (const Plant& plant : plants) in.push_back({&plant, {}});
  PlantCoupling coupling(wind.air());
  for (int i = 0; i < static_cast<int>(1.2 * length / 5 / 0.025); ++i) wind.step(0.025);
  const double start = processor_seconds();
  size_t frames = 0, air_steps = 0;
  for (auto _ : state) {
    wind.step(0.025, coupling.set_bodies(in));
    coupling.find(in, nullptr, wind.time(), 0.025);
    coupling.react(in);
    ++frames, air_steps += wind.air().size() * static_cast<size_t>(wind.substeps(0.025));
  }
  const double spent = processor_seconds() - start;
  state.counters["air"] = static_cast<double>(wind.air().size());
  state.counters["substeps"] = wind.substeps(0.025);
  state.counters["pairs"] = static_cast<double>(coupling.pairs());
  state.counters["bodies"] = static_cast<double>(coupling.body_count());
  state.counters["cpu_ms"] = 1e3 * spent / static_cast<double>(frames);
  state.counters["ns_per_particle_step"] = 1e9 * spent / static_cast<double>(air_steps);
}
BENCHMARK(wind_frame)
    ->Args({5000, 1, 0})
    ->Args({10000, 1, 0})
    ->Args({20000, 1, 0})
    ->Args({10000, 1, 10000})
    ->Args({5000, 2, 0})
    ->Args({10000, 2, 0})
    ->Args({20000, 2, 0})
    ->Args({10000, 2, 10000})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// A substep of air in which boxes move, a few spacings wide each. Arguments: air particles, boxes.
void air_step_by_moving_boxes(benchmark::State& state) {
  const Vec3 half = Vec3::Constant(0.25);
  SdfObstacle box(box_mesh(-half, half), {.voxel = 0.03});
  const std::vector<const SdfObstacle*> boxes(static_cast<size_t>(state.range(1)), &box);
  AirOptions options = air_options(static_cast<size_t>(state.range(0)), 1);
  MovingWalls walls(options.low, options.spacing / 2, 4 * options.spacing, boxes, 1);
  SphAir air(options, nullptr, &walls);
  box.place({.position = options.high / 2, .centre = options.high / 2, .angular_velocity = {0, 1, 0}});
  walls.place(0);
  fill(air);
  for (int i = 0; i < 5; ++i) walls.place(0), air.step(air.longest_step());
  const double start = processor_seconds();
  size_t done = 0;
  for (auto _ : state) walls.place(0), air.step(air.longest_step()), done += air.size();
  state.counters["ns_per_particle_step"] = 1e9 * (processor_seconds() - start) / static_cast<double>(done);
}
BENCHMARK(air_step_by_moving_boxes)
    ->Args({10000, 0})
    ->Args({10000, 1})
    ->Args({10000, 8})
    ->Unit(benchmark::kMillisecond);

/// The ambient wind at the particles of plants.
void ambient_wind(benchmark::State& state) {
  const AmbientWind wind;
  std::vector<Vec3> places(64), out(64);
  for (int i = 0; i < 64; ++i) places[i] = {0.1 * i, 1, 0.2 * i};
  double time = 0;
  for (auto _ : state) wind.velocities(places, time += 0.025, out), benchmark::DoNotOptimize(out.data());
  state.SetItemsProcessed(state.iterations() * 64);
}
BENCHMARK(ambient_wind)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace liana
