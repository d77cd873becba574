#include "tests/support/solids/other_solvers.h"

#include <fmt/os.h>

#include <fstream>
#include <sstream>

namespace liana {

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

void write_matrix(const std::filesystem::path& path, const Sparse& matrix) {
  auto out = fmt::output_file(path.string());
  out.print("%%MatrixMarket matrix coordinate real general\n{} {} {}\n", matrix.rows(), matrix.cols(),
            matrix.nonZeros());
  for (int c = 0; c < matrix.outerSize(); ++c)
    for (Sparse::InnerIterator entry(matrix, c); entry; ++entry)
      out.print("{} {} {:.17g}\n", entry.row() + 1, entry.col() + 1, entry.value());
}

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

}  // namespace liana
