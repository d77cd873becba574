// The offline stage: surfaces to tets to modes. domains/s is for one core.
#include <benchmark/benchmark.h>

#include "mesher/tets/tetrahedralize.h"
#include "modal/assembly.h"
#include "modal/cholesky.h"
#include "modal/lowest_mode.h"
#include "modal/subspace_iteration.h"
#include "tests/support/shapes.h"

namespace liana {
namespace {

/// Six-sided branches of aspect 10-100, no two of the same proportions.
std::vector<MarkedMesh> unique_branches(int count) {
  std::vector<MarkedMesh> branches;
  for (int i = 0; i < count; ++i) {
    const double length = 0.2 + 0.01 * i, aspect = 10 * std::pow(10., (i % 17) / 16.);
    branches.push_back(make_tube({.sides = 6,
                                  .length = length,
                                  .diameter = length / aspect,
                                  .tip_scale = 0.7,
                                  .bend = 0.3 * (i % 5) / 4.,
                                  .stations = {}}));
  }
  return branches;
}

void branches_with_tets(benchmark::State& state) {
  const std::vector<MarkedMesh> branches = unique_branches(64);
  size_t i = 0;
  double tets = 0;
  for (auto _ : state) {
    const MarkedMesh& b = branches[i++ % branches.size()];
    const TetMesh mesh = tetrahedralize(b.mesh, b.is_root);
    benchmark::DoNotOptimize(lowest_modes(mesh, {}, {}));
    tets += double(mesh.tets.size());
  }
  state.counters["domains/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["tets"] = tets / double(state.iterations());
}
BENCHMARK(branches_with_tets)->Unit(benchmark::kMillisecond);

void tetrahedra_of_branches(benchmark::State& state) {
  const std::vector<MarkedMesh> branches = unique_branches(64);
  size_t i = 0;
  for (auto _ : state) {
    const MarkedMesh& b = branches[i++ % branches.size()];
    benchmark::DoNotOptimize(tetrahedralize(b.mesh, b.is_root));
  }
}
BENCHMARK(tetrahedra_of_branches)->Unit(benchmark::kMillisecond);

/// A prism of about state.range(0) tets.
TetMesh prism_of(int64_t tets) {
  const int sides = tets < 200 ? 6 : tets < 1000 ? 12 : 24;
  std::vector<double> stations;
  const int rings = tets < 200 ? 5 : tets < 1000 ? 12 : 20;
  for (int i = 0; i <= rings; ++i) stations.push_back(double(i) / rings);
  const MarkedMesh prism = make_tube({.sides = sides, .length = 1, .diameter = 0.1, .stations = stations});
  return tetrahedralize(prism.mesh, prism.is_root);
}

void lowest_modes_of_prism(benchmark::State& state) {
  const TetMesh mesh = prism_of(state.range(0));
  uint32_t dof = 0;
  for (auto _ : state) dof = lowest_modes(mesh, {}, {}).dof;
  state.counters["tets"] = double(mesh.tets.size());
  state.counters["dof"] = dof;
}
BENCHMARK(lowest_modes_of_prism)->Arg(100)->Arg(500)->Arg(1600)->Unit(benchmark::kMillisecond);

void assembly_of_prism(benchmark::State& state) {
  const TetMesh mesh = prism_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(assemble(make_nodes(mesh, Element::T10), Element::T10, {}));
}
BENCHMARK(assembly_of_prism)->Arg(100)->Arg(500)->Arg(1600)->Unit(benchmark::kMillisecond);

void factor_of_prism(benchmark::State& state) {
  const TetMesh mesh = prism_of(state.range(0));
  const NodeMesh nodes = make_nodes(mesh, Element::T10);
  const System system = assemble(nodes, Element::T10, {});
  std::vector<uint8_t> held;
  for (const uint8_t root : nodes.on_root) held.insert(held.end(), 3, root);
  for (auto _ : state) benchmark::DoNotOptimize(free_matrix(system, held, 0));
}
BENCHMARK(factor_of_prism)->Arg(100)->Arg(500)->Arg(1600)->Unit(benchmark::kMillisecond);

void factor2_of_prism(benchmark::State& state) {
  const TetMesh mesh = prism_of(state.range(0));
  const NodeMesh nodes = make_nodes(mesh, Element::T10);
  const System system = assemble(nodes, Element::T10, {});
  std::vector<uint8_t> held;
  for (const uint8_t root : nodes.on_root) held.insert(held.end(), 3, root);
  const FreeMatrix m = free_matrix(system, held, 0);
  for (auto _ : state) benchmark::DoNotOptimize(Cholesky(m).positive_definite());
}
BENCHMARK(factor2_of_prism)->Arg(100)->Arg(500)->Arg(1600)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace liana
