// Our meshes and matrices as files of other solvers.
#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <vector>

#include "modal/solve/lowest_mode.h"

namespace liana {

using Sparse = Eigen::SparseMatrix<double>;

struct Matrices {
  Sparse K, M;  ///< free dof only, both triangles
};

/// held: per dof (3 a node), 1 if it is fixed at zero.
Matrices free_matrices(const System& system, const std::vector<uint8_t>& held);

/// Matrix Market coordinates, 17 digits.
void write_matrix(const std::filesystem::path& path, const Sparse& matrix);

/// A CalculiX input file: C3D10, whose node order is ours, clamped root, *FREQUENCY.
void write_calculix(const std::filesystem::path& path, const NodeMesh& nodes, const ElasticMaterial& material,
                    int modes);

/// Hz, from a .dat file's table "mode no, eigenvalue, rad/time, cycles/time, imaginary part".
std::vector<double> read_calculix(const std::filesystem::path& path);

}  // namespace liana
