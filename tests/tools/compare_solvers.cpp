// compare_solvers: one branch at three sizes through our FE, CalculiX and scipy's eigsh, on the same T10
// mesh.
//
// CPU seconds, one thread, the best of several. Ours: nodes, assembly and the two lowest modes. CalculiX: its
// whole process, user + system. eigsh: the call alone, shift-invert about 0, k = 2, matrices in memory.
#include <fmt/core.h>
#include <fmt/os.h>
#include <sys/resource.h>

#include <cstdlib>
#include <fstream>

#include "mesher/base/error.h"
#include "mesher/tets/tetrahedralize.h"
#include "modal/solve/eigenpairs.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/other_solvers.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

double cpu_seconds(int who) {
  rusage usage;
  getrusage(who, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

template <class Work>
double best_of(int runs, int repeats, int who, const Work& work) {
  double best = 1e300;
  for (int run = 0; run < runs; ++run) {
    const double start = cpu_seconds(who);
    for (int i = 0; i < repeats; ++i) work();
    best = std::min(best, (cpu_seconds(who) - start) / repeats);
  }
  return best;
}

constexpr const char* kEigsh =
    "import sys, time, scipy.io, scipy.sparse.linalg as s\n"
    "K, M = (scipy.io.mmread(k + '.mtx').tocsc() for k in 'KM')\n"
    "times = []\n"
    "for run in range(int(sys.argv[1])):\n"
    "  start = time.process_time()\n"
    "  values = s.eigsh(K, k=2, M=M, sigma=0)[0]\n"
    "  times.append(time.process_time() - start)\n"
    "print('%.9g %.17g' % (min(times), min(values)), file=open('eigsh.txt', 'w'))\n";

bool has(const char* what) {
  return std::system(fmt::format("{} > /dev/null 2>&1", what).c_str()) == 0;
}

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0)
    throw Error(Error::Kind::Output, "failed: " + command, "run it by hand");
}

/// "-" where a solver is not installed; a ratio below its bar is marked.
std::string ratio(double theirs, double ours, double bar) {
  if (theirs <= 0) return "-";
  const double times = theirs / ours;
  return bar > 0 ? fmt::format("{:.1f} (bar {:g}{})", times, bar, times < bar ? ", BELOW" : "")
                 : fmt::format("{:.1f}", times);
}

void compare(const MarkedMesh& branch, double calculix_bar, double eigsh_bar) {
  const TetMesh tets = tetrahedralize(branch.mesh, branch.is_root);
  const NodeMesh nodes = make_nodes(tets, Element::T10);
  std::vector<uint8_t> held;
  for (const uint8_t root : nodes.on_root) held.insert(held.end(), 3, root);
  Modes modes;
  const int repeats = std::max(1, static_cast<int>(40000 / tets.tets.size()));  // clocks tick in ms
  const double ours = best_of(7, repeats, RUSAGE_SELF, [&] { modes = lowest_modes(tets, {}, {}); });

  const ScratchFolder folder;
  double calculix = 0, eigsh = 0, apart = 0;
  if (has("command -v ccx")) {
    write_calculix(folder / "branch.inp", nodes, {}, 2);
    const std::string command =
        fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx branch > log.txt 2>&1", folder.path().string());
    calculix = best_of(5, 1, RUSAGE_CHILDREN, [&] { run(command); });
    apart = std::abs(read_calculix(folder / "branch.dat").at(0) / modes.frequencies[0] - 1);
  }
  if (has("/usr/bin/python3 -c 'import scipy.sparse.linalg'")) {
    const System system = assemble(nodes, Element::T10, {});
    const Matrices matrices = free_matrices(system, held);
    write_matrix(folder / "K.mtx", matrices.K), write_matrix(folder / "M.mtx", matrices.M);
    fmt::output_file((folder / "time.py").string()).print("{}", kEigsh);
    run(fmt::format("cd '{}' && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 /usr/bin/python3 time.py {}",
                    folder.path().string(), std::max(5, repeats / 10)));
    double eigenvalue = 0;
    std::ifstream(folder / "eigsh.txt") >> eigsh >> eigenvalue;
    const double frequency = std::sqrt(eigenvalue) / (2 * kPi * system.time);
    apart = std::max(apart, std::abs(frequency / modes.frequencies[0] - 1));
  }
  fmt::print("{:5}  {:6}  {:9.3f}  {:12.1f}  {:9.2f}  {:18}  {:18}  {:.0e}\n", tets.tets.size(), modes.dof,
             1e3 * ours, 1e3 * calculix, 1e3 * eigsh, ratio(calculix, ours, calculix_bar),
             ratio(eigsh, ours, eigsh_bar), apart);
}

/// A branch of a metre with rings at equal distances, for meshes of any size.
MarkedMesh even_tube(int sides, int rings) {
  TubeShape shape{.sides = sides, .diameter = 0.06, .tip_scale = 0.6, .bend = 0.4, .stations = {}};
  for (int i = 0; i <= rings; ++i) shape.stations.push_back(shape.length * i / rings);
  return make_tube(shape);
}

}  // namespace
}  // namespace liana

int main() {
  using namespace liana;
  try {
    fmt::print(
        " tets     dof   ours, ms  CalculiX, ms  eigsh, ms  CalculiX / ours     eigsh / ours        apart\n");
    compare(make_prism(6, 0.3, 0.06), 8, 2.5);
    compare(make_prism(6, 0.3, 0.02), 8, 2.5);
    compare(even_tube(8, 20), 0, 2.5);
    compare(even_tube(12, 40), 5, 2.5);
  } catch (const Error& error) {
    fmt::print(stderr, "compare_solvers: {}\n", error.what());
    return 1;
  }
}
