// The same matrices through Spectra and ARPACK, the same mesh through CalculiX.
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <arpack/arpack.h>
#include <fmt/os.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/SparseCholesky>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "mesher/tets/tetrahedralize.h"
#include "modal/lowest_mode.h"
#include "modal/subspace_iteration.h"
#include "tests/support/shapes.h"

namespace liana {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

struct Matrices {
  Sparse K, M;  ///< free dof only
};

Matrices free_matrices(const System& system, const std::vector<uint8_t>& held) {
  std::vector<int> index(held.size(), -1);
  int count = 0;
  for (size_t dof = 0; dof < held.size(); ++dof)
    if (!held[dof]) index[dof] = count++;
  std::vector<Eigen::Triplet<double>> K, M;
  const auto add = [&](std::vector<Eigen::Triplet<double>>& to, size_t row, size_t column, double value) {
    if (index[row] < 0 || index[column] < 0) return;
    to.emplace_back(index[row], index[column], value);
  };
  for (size_t j = 0; j < system.nodes(); ++j)
    for (uint32_t e = system.start[j]; e < system.start[j + 1]; ++e) {
      const size_t i = system.row[e];
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          add(K, 3 * i + a, 3 * j + b, system.stiffness[e](a, b));
          if (i != j) add(K, 3 * j + b, 3 * i + a, system.stiffness[e](a, b));
        }
        add(M, 3 * i + a, 3 * j + a, system.mass[e]);
        if (i != j) add(M, 3 * j + a, 3 * i + a, system.mass[e]);
      }
    }
  Matrices matrices{Sparse(count, count), Sparse(count, count)};
  matrices.K.setFromTriplets(K.begin(), K.end());
  matrices.M.setFromTriplets(M.begin(), M.end());
  return matrices;
}

/// A branch of aspect 15 with a mass at its side, so that no two modes are equal.
class OtherSolvers : public testing::Test {
 protected:
  static constexpr int kModes = 4;
  MarkedMesh prism = make_prism(6, 0.3, 0.02);
  TetMesh tets = tetrahedralize(prism.mesh, prism.is_root);
  NodeMesh nodes = make_nodes(tets, Element::T10);
  System system = assemble(nodes, Element::T10, {});
  std::vector<uint8_t> held;
  Matrices matrices;

  void SetUp() override {
    for (const uint8_t root : nodes.on_root) held.insert(held.end(), 3, root);
    const CarriedMass carried{Vec3(0.01, 0.2, 0), 0.01};
    for (const NodeMass& m : lump(tets, std::span(&carried, 1))) system.add_mass(m.node, m.mass);
    matrices = free_matrices(system, held);
  }
  Eigen::VectorXd ours() const {
    const EigenResult result = lowest_eigenpairs(system, held, {.modes = kModes});
    EXPECT_TRUE(result.converged);
    return result.eigenvalues;
  }
};

// 1e-7: rounding of K's condition (1e9 · eps) on either side.
TEST_F(OtherSolvers, SpectraFindsTheSameEigenvalues) {
  using Operator = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
  Operator inverse(matrices.K, matrices.M);
  Spectra::SparseSymMatProd<double> mass(matrices.M);
  Spectra::SymGEigsShiftSolver<Operator, Spectra::SparseSymMatProd<double>, Spectra::GEigsMode::ShiftInvert>
      solver(inverse, mass, kModes, 20, 0);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-12, Spectra::SortRule::SmallestAlge);
  ASSERT_EQ(solver.info(), Spectra::CompInfo::Successful);
  const Eigen::VectorXd found = solver.eigenvalues(), mine = ours();
  for (int i = 0; i < kModes; ++i) EXPECT_NEAR(mine[i] / found[i], 1, 1e-7) << "mode " << i + 1;
}

TEST_F(OtherSolvers, ArpackFindsTheSameEigenvalues) {
  const Eigen::SimplicialLDLT<Sparse> inverse(matrices.K);
  const Sparse& M = matrices.M;
  const int n = static_cast<int>(M.rows()), ncv = 20, lworkl = ncv * (ncv + 8);
  Eigen::VectorXd residual = Eigen::VectorXd::Ones(n), workd(3 * n), workl(lworkl);
  Eigen::MatrixXd basis(n, ncv);
  int ido = 0, info = 1, iparam[11] = {1, 0, 1000, 1, 0, 0, 3}, ipntr[11] = {};
  while (ido != 99) {  // mode 3: shift-invert about 0
    dsaupd_c(&ido, "G", n, "LM", kModes, 1e-12, residual.data(), ncv, basis.data(), n, iparam, ipntr,
             workd.data(), workl.data(), lworkl, &info);
    Eigen::Map<Eigen::VectorXd> x(workd.data() + ipntr[0] - 1, n), y(workd.data() + ipntr[1] - 1, n);
    if (ido == -1) y = inverse.solve(M * x);
    if (ido == 1) y = inverse.solve(Eigen::Map<Eigen::VectorXd>(workd.data() + ipntr[2] - 1, n));
    if (ido == 2) y = M * x;
  }
  ASSERT_EQ(info, 0);
  Eigen::VectorXd found(kModes);
  int select[20] = {};
  dseupd_c(0, "A", select, found.data(), basis.data(), n, 0, "G", n, "LM", kModes, 1e-12, residual.data(),
           ncv, basis.data(), n, iparam, ipntr, workd.data(), workl.data(), lworkl, &info);
  ASSERT_EQ(info, 0);
  std::sort(found.begin(), found.end());
  const Eigen::VectorXd mine = ours();
  for (int i = 0; i < kModes; ++i) EXPECT_NEAR(mine[i] / found[i], 1, 1e-7) << "mode " << i + 1;
}

/// A CalculiX input file: C3D10, whose node order is ours, clamped root, *FREQUENCY.
void write_calculix(const std::filesystem::path& path, const NodeMesh& nodes, const ElasticMaterial& material,
                    int modes) {
  auto out = fmt::output_file(path.string());
  out.print("*NODE, NSET=NALL\n");
  for (size_t n = 0; n < nodes.positions.size(); ++n) {
    const Vec3& p = nodes.positions[n];
    out.print("{},{:.11e},{:.11e},{:.11e}\n", n + 1, p.x(), p.y(), p.z());  // it reads 12 significant digits
  }
  out.print("*ELEMENT, TYPE=C3D10, ELSET=EALL\n");
  for (size_t e = 0; e < nodes.element_count(); ++e) {
    out.print("{}", e + 1);
    for (const uint32_t n : nodes.element(e)) out.print(",{}", n + 1);
    out.print("\n");
  }
  out.print("*NSET, NSET=ROOT\n");
  for (size_t n = 0; n < nodes.positions.size(); ++n)
    if (nodes.on_root[n]) out.print("{}\n", n + 1);
  out.print("*MATERIAL, NAME=WOOD\n*ELASTIC\n{},{}\n*DENSITY\n{}\n", material.youngs_modulus,
            material.poisson_ratio, material.density);
  out.print("*SOLID SECTION, ELSET=EALL, MATERIAL=WOOD\n*BOUNDARY\nROOT,1,3\n");
  out.print("*STEP\n*FREQUENCY\n{}\n*NODE FILE\nU\n*END STEP\n", modes);
}

/// Hz, from the table "mode no, eigenvalue, rad/time, cycles/time, imaginary part".
std::vector<double> read_calculix(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<double> frequencies;
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line);
    int mode = 0;
    double eigenvalue, omega, frequency, imaginary;
    if (row >> mode >> eigenvalue >> omega >> frequency >> imaginary &&
        mode == static_cast<int>(frequencies.size()) + 1)
      frequencies.push_back(std::sqrt(eigenvalue) / (2 * kPi));
  }
  return frequencies;
}

// CalculiX prints 7 digits and integrates the mass with 4 points, ours is exact. The difference grows with
// the mode's curvature in an element: 4e-6 for the first bending pair on such meshes, 20 times that for the
// second.
TEST_F(OtherSolvers, CalculixFindsTheSameFrequenciesOnTheSameMesh) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "CalculiX (ccx) is not installed";
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("liana-calculix-{}", getpid());
  std::filesystem::create_directories(folder);
  write_calculix(folder / "branch.inp", nodes, {}, kModes);
  const int status = std::system(
      fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx branch > log.txt 2>&1", folder.string()).c_str());
  const std::vector<double> found = read_calculix(folder / "branch.dat");
  std::filesystem::remove_all(folder);
  ASSERT_EQ(status, 0);
  ASSERT_GE(found.size(), static_cast<size_t>(kModes));
  const Modes mine = lowest_modes(tets, {}, {}, {.modes = kModes});
  for (int i = 0; i < kModes; ++i)
    EXPECT_NEAR(mine.frequencies[i] / found[i], 1, i < 2 ? 1e-5 : 2e-4) << "mode " << i + 1;
}

}  // namespace
}  // namespace liana
