// The time step: nanoseconds per particle, against the plain solver, over sizes and threads; changes of the
// tree.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "mesher/base/parallel.h"
#include "mesher/base/stopwatch.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/breaking.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/generalized_alpha.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/reference_step.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

constexpr int kParticlesPerBranch = 91;  // branch, 3 twigs, 6 leaves with the default chain lengths

Plant tree_of(double particles) {
  const int branches = std::max(1, static_cast<int>(std::lround(particles / kParticlesPerBranch)));
  return make_plant(test::synthetic_bake({.branches = branches}));
}

// Processor time: other programs may share the machine.
double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// The shortest of many turns: what the machine can do when nothing else runs.
template <class Work>
double best_seconds(int turns, Work&& work) {
  double best = 1e9;
  for (int i = 0; i < turns; ++i) {
    const double start = processor_seconds();
    work();
    best = std::min(best, processor_seconds() - start);
  }
  return best;
}

double step_ns(Plant& plant, int turns, const lanes::Kernels& kernels = lanes::best_kernels()) {
  PlantStepper stepper;
  stepper.use(kernels);
  return 1e9 * best_seconds(turns, [&] { stepper.step(plant, {}, {}, {}); }) /
         static_cast<double>(plant.particles.size());
}

void full_step(benchmark::State& state) {
  Plant plant = tree_of(static_cast<double>(state.range(0)));
  Plant plain = plant;
  const auto n = static_cast<double>(plant.particles.size());
  double ns = 1e9, avx2_ns = 1e9, plain_ns = 1e9;
  test::ReferenceStepper reference;
  for (auto _ : state) {
    ns = std::min(ns, step_ns(plant, 20));
    if (lanes::avx2_kernels()) avx2_ns = std::min(avx2_ns, step_ns(plant, 20, *lanes::avx2_kernels()));
    plain_ns = std::min(plain_ns, 1e9 / n * best_seconds(5, [&] { reference.step(plain, {}, {}, {}); }));
  }
  state.counters["particles"] = n;
  state.counters["ns_per_particle"] = ns;
  if (lanes::avx2_kernels()) state.counters["avx2_ns"] = avx2_ns;
  state.counters["plain_ns"] = plain_ns;
  state.counters["plain/lanes"] = plain_ns / ns;
}
BENCHMARK(full_step)->Arg(1000)->Arg(5000)->Arg(25000)->Unit(benchmark::kMillisecond);

// [Haedrich17]'s scheme, one pass, beside the direct step of the same plant.
void direct_against_shape_matching(benchmark::State& state) {
  Plant direct = tree_of(25000), shapes = direct;
  shapes.scheme.solver = Solver::ShapeMatching;
  double ns = 1e9, shape_ns = 1e9;
  for (auto _ : state) {
    ns = std::min(ns, step_ns(direct, 20));
    shape_ns = std::min(shape_ns, step_ns(shapes, 20));
  }
  state.counters["particles"] = static_cast<double>(direct.particles.size());
  state.counters["ns_per_particle"] = ns;
  state.counters["shape_matching_ns"] = shape_ns;
  state.counters["direct/shape_matching"] = ns / shape_ns;
}
BENCHMARK(direct_against_shape_matching)->Unit(benchmark::kMillisecond);

// 25,000 particles as a hundred plants, one after the other on one core.
void full_step_of_a_hundred_plants(benchmark::State& state) {
  std::vector<Plant> plants(100, tree_of(250));
  std::vector<PlantStepper> steppers(plants.size());
  StepWorkspace workspace;
  double best = 1e9;
  for (auto _ : state)
    best = std::min(best, best_seconds(10, [&] {
                      for (size_t i = 0; i < plants.size(); ++i)
                        steppers[i].step(plants[i], {}, {}, {}, workspace);
                    }));
  const double n = 100 * static_cast<double>(plants[0].particles.size());
  state.counters["particles"] = n;
  state.counters["ns_per_particle"] = 1e9 * best / n;
}
BENCHMARK(full_step_of_a_hundred_plants)->Unit(benchmark::kMillisecond);

/// s: elimination and substitution by the plain solver, the best of ten.
double plain_solver_seconds(const Plant& plant) {
  TreeSolver plain;
  plain.resize(plant.particles.size());
  const TreeJoint joint{Vec3(0, -0.02, 0), Vec3(0, 0.02, 0), 100 * Mat3::Identity(), Mat3::Identity()};
  double best = 1e9;
  for (int turn = 0; turn < 10; ++turn) {
    for (size_t i = 0; i < plant.particles.size(); ++i)
      plain.reset(i, 1, 1e-4 * Mat3::Identity(), Vec3(0, -1, 0), Vec3::Zero());
    best = std::min(best, best_seconds(1, [&] {
                      for (size_t i = plant.particles.size(); i-- > 0;)
                        plain.eliminate(i, plant.particles[i].parent.value, joint);
                      for (size_t i = 0; i < plant.particles.size(); ++i)
                        benchmark::DoNotOptimize(plain.substitute(i));
                    }));
  }
  return best;
}

/// What the kernels work on: a step from rest, from and to nowhere.
lanes::StepView step_view(const Plant& plant, const EliminationOrder& order, std::vector<double>& pose,
                          std::vector<double>& block, std::vector<double>& record) {
  const GeneralizedAlpha method(plant.scheme.rho_infinity);
  const double h = plant.scheme.dt;
  return {
      .particle = static_cast<const double*>(static_cast<const void*>(plant.particles.data())),
      .from = static_cast<const double*>(static_cast<const void*>(plant.motion.data())),
      .to = nullptr,
      .pose = pose.data(),
      .block = block.data(),
      .record = record.data(),
      .packs = order.packs().data(),
      .pack_count = order.packs().size(),
      .gravity = {0, -9.81, 0},
      .h = h,
      .alpha_m = method.alpha_m,
      .alpha_f = method.alpha_f,
      .before = method.before,
      .after = method.beta,
      .gamma = method.gamma,
      .position_rate = (1 - method.alpha_f) * method.beta * h * h,
      .velocity_rate = (1 - method.alpha_f) * method.gamma * h,
  };
}

// Elimination and substitution alone, part by part as the step does them, joints and loads given.
void factor_and_solve(benchmark::State& state) {
  const Plant plant = tree_of(static_cast<double>(state.range(0)));
  EliminationOrder order;
  order.update(plant.particles, false);
  const auto count = static_cast<double>(plant.particles.size());
  std::vector<double> pose(lanes::kPoseStride * order.pose_slots()),
      block(lanes::kBlockStride * order.block_slots()),
      record(4 * lanes::kRecordLanes * order.packs().size());
  pose[lanes::kPoseStride * order.world_slot() + 7] = 1;
  const lanes::Kernels& kernels = lanes::best_kernels();
  const lanes::StepView view = step_view(plant, order, pose, block, record);
  const EliminationOrder::Supernode top = order.top();
  double best = 1e9;
  for (auto _ : state) {
    for (int turn = 0; turn < 20; ++turn) {
      double seconds = 0;
      std::fill(block.begin(), block.end(), 0.0);
      kernels.predict(view, top.first, top.last);
      kernels.assemble(view, top.first, top.last);
      for (const EliminationOrder::Supernode& part : order.supernodes()) {
        kernels.predict(view, part.first, part.last);
        kernels.assemble(view, part.first, part.last);
        const double start = processor_seconds();
        kernels.factor(view, part.first, part.last);
        seconds += processor_seconds() - start;
      }
      const double start = processor_seconds();
      for (const EliminationOrder::ExtendAdd& hand : order.extend_adds())
        for (uint32_t i = 0; i < lanes::kBlockStride; ++i)
          block[lanes::kBlockStride * hand.to + i] += block[lanes::kBlockStride * hand.from + i];
      kernels.factor(view, top.first, top.last);
      kernels.substitute(view, top.first, top.last);
      for (const EliminationOrder::Supernode& part : order.supernodes())
        kernels.substitute(view, part.first, part.last);
      seconds += processor_seconds() - start;
      best = std::min(best, seconds);
    }
  }
  state.counters["particles"] = count;
  state.counters["ns_per_particle"] = 1e9 * best / count;
  state.counters["plain/lanes"] = plain_solver_seconds(plant) / best;
}
BENCHMARK(factor_and_solve)->Arg(1000)->Arg(25000)->Unit(benchmark::kMillisecond);

// Cost grows as particlesᵉˣᵖᵒⁿᵉⁿᵗ from a thousand to a million, in plants of a thousand; and in one plant.
void scaling(benchmark::State& state) {
  const bool one_plant = state.range(0) == 1;
  const double sizes[] = {1e3, 1e4, 1e5, 1e6};
  double logs[4], costs[4];
  for (auto _ : state) {
    for (int k = 0; k < 4; ++k) {
      const auto count = one_plant ? size_t{1} : static_cast<size_t>(sizes[k] / 1e3);
      std::vector<Plant> plants(count, tree_of(one_plant ? sizes[k] : 1e3));
      std::vector<PlantStepper> steppers(count);
      const double seconds = best_seconds(k == 3 ? 4 : 10, [&] {
        for (size_t i = 0; i < count; ++i) steppers[i].step(plants[i], {}, {}, {});
      });
      logs[k] = std::log(static_cast<double>(count * plants[0].particles.size()));
      costs[k] = std::log(seconds);
    }
  }
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < 4; ++k)
    sx += logs[k], sy += costs[k], sxx += logs[k] * logs[k], sxy += logs[k] * costs[k];
  state.counters["exponent"] = (4 * sxy - sx * sy) / (4 * sxx - sx * sx);
  state.counters["ns_at_1k"] = 1e9 * std::exp(costs[0] - logs[0]);
  state.counters["ns_at_1M"] = 1e9 * std::exp(costs[3] - logs[3]);
}
BENCHMARK(scaling)->ArgName("one_plant")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);

// Wall clock: only tells something on a machine that has nothing else to do.
void two_threads_against_one(benchmark::State& state) {
  std::vector<Plant> plants(100, tree_of(250));
  std::vector<PlantStepper> steppers(plants.size());
  StepWorkspace workspaces[2];
  double best[2] = {1e9, 1e9};
  for (auto _ : state)
    for (int turn = 0; turn < 20; ++turn)
      for (unsigned threads : {1u, 2u}) {
        const double seconds = timed([&] {
          parallel_for(plants.size(), threads, [&](size_t i, unsigned worker) {
            steppers[i].step(plants[i], {}, {}, {}, workspaces[worker]);
          });
        });
        best[threads - 1] = std::min(best[threads - 1], seconds);
      }
  state.counters["speedup"] = best[0] / best[1];
}
BENCHMARK(two_threads_against_one)->Unit(benchmark::kMillisecond)->UseRealTime();

// The same for one plant of 25,000 particles, whose parts the threads share.
void one_plant_on_two_threads(benchmark::State& state) {
  Plant plant = tree_of(25000);
  PlantStepper stepper;
  double best[2] = {1e9, 1e9};
  for (auto _ : state)
    for (int turn = 0; turn < 40; ++turn)
      for (unsigned threads : {1u, 2u})
        best[threads - 1] =
            std::min(best[threads - 1], timed([&] { stepper.step(plant, {}, {}, {.threads = threads}); }));
  state.counters["speedup"] = best[0] / best[1];
  state.counters["ns_per_particle"] = 1e9 * best[1] / static_cast<double>(plant.particles.size());
}
BENCHMARK(one_plant_on_two_threads)->Unit(benchmark::kMillisecond)->UseRealTime();

// Cut one branch off a single plant of 25,000 particles, calibrate those that carried it anew, take the next
// step's order; put it back.
void change_one_branch(benchmark::State& state) {
  Plant plant = tree_of(25000);
  std::vector<double> carried = carried_masses(plant);
  PlantStepper stepper;
  stepper.step(plant, {}, {}, {});
  HeldChain chain;
  EliminationOrder order;  // a stepper's own: it has the memory from the step before
  order.update(plant.particles, false);
  double cut = 1e9, grow = 1e9, step = 1e9;
  for (auto _ : state) {
    step = std::min(step, best_seconds(3, [&] { stepper.step(plant, {}, {}, {}); }));
    const BranchId id(plant.branches.size() / 2);
    const Branch branch = plant.branches[id.index()];
    const ParticleId at = plant.particles[branch.particles[0].index()].parent;
    Plant piece;
    cut = std::min(cut, best_seconds(1, [&] {
                     add_carried(plant, at, id, -subtree_mass(plant, branch.particles[0]), carried);
                     Remap change;
                     piece = detach_subtree(plant, branch.particles[0], &change);
                     for (size_t i = 0; i < carried.size(); ++i)
                       if (change.particles[i].valid()) carried[change.particles[i].index()] = carried[i];
                     carried.resize(plant.particles.size());
                     for (BranchId b = branch.parent; b.valid();
                          b = plant.branches[change.branches[b.index()].index()].parent)
                       recalibrate(plant, change.branches[b.index()], carried, chain);
                     order.update(plant.particles, true);
                   }));
    grow = std::min(grow, best_seconds(1, [&] {
                      const BranchId added =
                          append_branch(plant, piece.branches[0], at, piece.particles, piece.motion);
                      carried.resize(plant.particles.size(), 0.0);
                      add_carried(plant, at, added,
                                  subtree_mass(plant, plant.branches[added.index()].particles[0]), carried);
                      for (BranchId b = added; b.valid(); b = plant.branches[b.index()].parent)
                        recalibrate(plant, b, carried, chain);
                      order.update(plant.particles, true);
                    }));
  }
  state.counters["particles"] = static_cast<double>(plant.particles.size());
  state.counters["cut_us"] = 1e6 * cut;
  state.counters["grow_us"] = 1e6 * grow;
  state.counters["step_us"] = 1e6 * step;
}
BENCHMARK(change_one_branch)->Iterations(20)->Unit(benchmark::kMicrosecond);

// What it costs each step to ask 25,000 joints whether they break; none does.
void look_for_fractures(benchmark::State& state) {
  Plant plant = tree_of(25000);
  for (Branch& branch : plant.branches) branch.strength = 1e12;
  std::vector<Fracture> found;
  double best = 1e9;
  for (auto _ : state) best = std::min(best, best_seconds(5, [&] { find_fractures(plant, 8, found); }));
  state.counters["ns_per_particle"] = 1e9 * best / static_cast<double>(plant.particles.size());
}
BENCHMARK(look_for_fractures)->Iterations(10)->Unit(benchmark::kMicrosecond);

void recalibrate_branch(benchmark::State& state) {
  Plant plant = test::rod_plant({}, static_cast<int>(state.range(0)));
  const std::vector<double> carried = carried_masses(plant);
  HeldChain chain;
  for (auto _ : state) benchmark::DoNotOptimize(recalibrate(plant, BranchId(0), carried, chain));
}
BENCHMARK(recalibrate_branch)->Arg(4)->Arg(20)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace liana
