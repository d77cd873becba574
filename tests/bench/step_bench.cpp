// The time step and the calibration: ns per particle.
#include <benchmark/benchmark.h>

#include <ctime>

#include "runtime/sim/plant_from_bake.h"
#include "runtime/sim/time_step.h"
#include "tests/support/synthetic_bake.h"

namespace liana {
namespace {

constexpr int kParticlesPerBranch =
    79;  // branch, 3 twigs, 6 leaves with the default chain lengths: see the counter

Plant tree_of(size_t particles) {
  const int branches = std::max(1, static_cast<int>(particles) / kParticlesPerBranch);
  return make_plant(test::synthetic_bake({.branches = branches}));
}

void step(benchmark::State& state) {
  Plant plant = tree_of(static_cast<size_t>(state.range(0)));
  const std::vector<Wrench> wind(plant.particles.size(), {.force = {1e-4, 0, 2e-5}});
  PlantStepper stepper;
  int solves = 0, steps = 0;
  const std::clock_t start = std::clock();  // processor time: other programs may share the machine
  for (auto _ : state) {
    solves += stepper.step(plant, wind, {}, {}).solves;
    ++steps;
  }
  const double spent = 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const auto n = static_cast<double>(plant.particles.size());
  state.counters["particles"] = n;
  state.counters["solves_per_step"] = static_cast<double>(solves) / steps;
  state.counters["ns_per_particle"] = spent / steps / n;
}
BENCHMARK(step)->Arg(1000)->Arg(25000)->Unit(benchmark::kMicrosecond);

void recalibrate_branch(benchmark::State& state) {
  Plant plant = test::rod_plant({}, static_cast<int>(state.range(0)));
  const std::vector<double> carried = carried_masses(plant);
  HeldChain chain;
  for (auto _ : state) benchmark::DoNotOptimize(recalibrate(plant, BranchId(0), carried, chain));
}
BENCHMARK(recalibrate_branch)->Arg(4)->Arg(20)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace liana
