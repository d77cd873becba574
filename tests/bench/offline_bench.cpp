// The offline stage: surfaces to tets to modes. domains/s is for one core.
#include <benchmark/benchmark.h>

#include <cmath>

#include "mesher/tets/tetrahedralize.h"
#include "modal/domains/domain_modes.h"
#include "modal/elements/assembly.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

/// Six-sided branches of aspect 10-100, tapered and bent, no two of the same proportions, on the default mesh
/// (at most 1 % from the converged frequency: the tests of LowestMode).
std::vector<TubeShape> branch_shapes(int count) {
  std::vector<TubeShape> shapes;
  for (int i = 0; i < count; ++i) {
    const double length = 0.2 + 0.01 * i, aspect = 10 * std::pow(10., (i % 17) / 16.);
    shapes.push_back({.sides = 6,
                      .length = length,
                      .diameter = length / aspect,
                      .tip_scale = 0.6 + 0.05 * (i % 7),
                      .bend = 0.3 * (i % 5) / 4.,
                      .stations = {}});
  }
  return shapes;
}

std::vector<MarkedMesh> unique_branches(int count) {
  std::vector<MarkedMesh> branches;
  for (const TubeShape& shape : branch_shapes(count)) branches.push_back(make_tube(shape));
  return branches;
}

/// The whole path on one core: gates, tets, modes.
void domains_with_tets(benchmark::State& state) {
  const std::vector<MarkedMesh> branches = unique_branches(64);
  std::vector<Solid> solids;
  for (const MarkedMesh& b : branches) solids.push_back({&b.mesh, b.is_root, {}});
  Progress silent;
  AllModes all;
  for (auto _ : state) all = solve_domains(solids, {}, {.modes = {}, .tets = {}, .threads = 1}, silent);
  double tets = 0, dof = 0, unsolved = 0;
  for (size_t i = 0; i < solids.size(); ++i) {
    tets += all.domains[i].tets / double(solids.size());
    dof += all.domains[i].dof / double(solids.size());
    unsolved += !all.domains[i].converged || all.domains[i].solved_as != i;
  }
  state.counters["domains/s"] =
      benchmark::Counter(double(solids.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["tets"] = tets;
  state.counters["dof"] = dof;
  state.counters["unsolved"] = unsolved;
}
BENCHMARK(domains_with_tets)->Unit(benchmark::kMillisecond);

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

}  // namespace
}  // namespace liana
