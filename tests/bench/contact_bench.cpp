// Contacts between plants on one core: a swaying tree's own twigs and leaves, and a garden of such trees.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/contact/plant_contacts.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

// Processor time: other programs may share the machine.
double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Plant moved(Plant plant, const Quat& turn, const Vec3& way) {
  for (Motion& m : plant.motion) {
    m.position = turn * m.position + way;
    m.orientation = turn * m.orientation;
  }
  for (Particle& particle : plant.particles) {
    if (particle.parent.valid()) continue;
    particle.joint.on_parent = turn * particle.joint.on_parent + way;
    particle.joint.rest = turn * particle.joint.rest;
  }
  return plant;
}

// Trees of about 2500 particles, 1.5 m apart, so that crowns touch; moving at up to 0.5 m/s.
void plant_contacts(benchmark::State& state) {
  const auto trees = static_cast<int>(state.range(0)) / 2500;
  const Plant tree = make_plant(test::synthetic_bake({.branches = 27}));
  const auto side = static_cast<int>(std::ceil(std::sqrt(trees)));
  std::vector<Plant> plants;
  for (int i = 0; i < trees; ++i) {
    const Quat turn(Eigen::AngleAxisd(i, Vec3::UnitY()));
    plants.push_back(moved(tree, turn, {1.5 * (i % side), 0, 1.5 * (i / side)}));
  }
  std::vector<PlantStepper> steppers(plants.size());
  std::vector<std::vector<WorldSpring>> springs(plants.size());
  std::vector<const Plant*> all;
  std::vector<std::vector<WorldSpring>*> lists;
  size_t particles = 0;
  for (size_t i = 0; i < plants.size(); ++i) {
    for (Motion& m : plants[i].motion) m.velocity = 0.15 * m.position.y() * Vec3(std::cos(i), 0, std::sin(i));
    all.push_back(&plants[i]);
    lists.push_back(&springs[i]);
    particles += plants[i].particles.size();
  }
  PlantContacts contacts;
  PlantContactReport report;
  double seconds = 0, worst = 0, best = 1e9;
  size_t steps = 0, listed = 0;
  for (auto _ : state) {
    for (auto& list : springs) list.clear();
    const double start = processor_seconds();
    report = contacts.gather(all, lists);
    const double took = processor_seconds() - start;
    if (steps > 0) seconds += took, worst = std::max(worst, took), best = std::min(best, took);
    listed += report.listed;
    ++steps;
    for (size_t i = 0; i < plants.size(); ++i) steppers[i].step(plants[i], {}, springs[i], {});
  }
  state.counters["particles"] = static_cast<double>(particles);
  state.counters["mean_ms"] = 1e3 * seconds / static_cast<double>(steps - 1);
  state.counters["best_ms"] = 1e3 * best;
  state.counters["worst_ms"] = 1e3 * worst;
  state.counters["listed"] = static_cast<double>(listed) / static_cast<double>(steps * particles);
  state.counters["candidates"] = static_cast<double>(report.candidates);
  state.counters["contacts"] = static_cast<double>(report.contacts);
}
BENCHMARK(plant_contacts)->Arg(25000)->Arg(250000)->Iterations(40)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace liana
