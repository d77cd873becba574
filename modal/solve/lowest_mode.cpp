#include "modal/solve/lowest_mode.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesher/base/error.h"
#include "modal/elements/strain_energy.h"
#include "modal/solve/eigenpairs.h"

namespace liana {
namespace {

/// Where the frequency's error, its square, reaches 1 %.
constexpr double kLargestRounding = 0.1;

/// Every tet must reach the root through shared vertices: a loose part would make K singular, but only just,
/// and rounding could hide it.
void check_held(const TetMesh& mesh) {
  if (mesh.root_faces.empty())
    throw Error(Error::Kind::Input, "no face is held: the solid has no root interface",
                "mark the faces nearest the parent as root");
  std::vector<uint32_t> up(mesh.positions.size());
  std::iota(up.begin(), up.end(), 0u);
  const auto top = [&](uint32_t v) {
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
  };
  for (const auto& tet : mesh.tets)
    for (int k = 1; k < 4; ++k) up[top(tet[k])] = top(tet[0]);
  std::vector<uint8_t> held(mesh.positions.size(), 0);
  for (const auto& face : mesh.root_faces) held[top(face[0])] = 1;
  for (const auto& tet : mesh.tets)
    if (!held[top(tet[0])])
      throw Error(Error::Kind::Input, "a part of the solid is not connected to its root interface",
                  "split it into one domain for each connected body");
}

std::vector<uint8_t> held_dofs(const NodeMesh& nodes) {
  std::vector<uint8_t> used(nodes.positions.size(), 0);
  for (const uint32_t n : nodes.elements) used[n] = 1;
  std::vector<uint8_t> held(3 * nodes.positions.size());
  for (size_t n = 0; n < nodes.positions.size(); ++n)
    std::fill_n(held.begin() + 3 * n, 3, nodes.on_root[n] || !used[n]);
  return held;
}

Vec3 direction_of_largest(const NodalVectors& vectors, int mode) {
  Vec3 largest = Vec3::Zero();
  for (Eigen::Index n = 0; n < vectors.rows() / 3; ++n) {
    const Vec3 u = vectors.block<3, 1>(3 * n, mode);
    if (u.squaredNorm() > largest.squaredNorm()) largest = u;
  }
  return largest.normalized();
}

}  // namespace

Modes lowest_modes(const TetMesh& mesh, const ElasticMaterial& material, std::span<const CarriedMass> carried,
                   const ModeOptions& options, std::span<const ElementScaling> scaling) {
  require(options.modes >= 1, "ask for at least one mode");
  check_held(mesh);
  const NodeMesh nodes = make_nodes(mesh, options.element);
  System system = assemble(nodes, options.element, material, scaling);
  for (const NodeMass& lumped : lump(mesh, carried)) system.add_mass(lumped.node, lumped.mass);
  const EigenResult pairs = lowest_eigenpairs(system, held_dofs(nodes), {.modes = options.modes});
  const Eigen::VectorXd eigenvalues =
      stiffness_quotients(nodes, system, material.poisson_ratio, pairs.vectors, scaling);

  const auto frequency = [&](double lambda) {
    return std::sqrt(std::max(0.0, lambda)) / (2 * kPi * system.time);
  };
  Modes modes;
  for (Eigen::Index i = 0; i < pairs.eigenvalues.size(); ++i) {
    modes.frequencies.push_back(frequency(eigenvalues[i]));
    modes.rounding = std::max(modes.rounding, std::abs(pairs.eigenvalues[i] / eigenvalues[i] - 1));
    modes.shapes.push_back(pairs.vectors.col(i) / std::sqrt(system.mass_unit));
    modes.tip_direction.push_back(direction_of_largest(pairs.vectors, static_cast<int>(i)));
  }
  for (int i = 0; i < 2; ++i) {
    modes.sway.frequencies[i] = frequency(pairs.sway_eigenvalues[i]);
    modes.sway.directions[i] = pairs.sway_directions.col(i);
  }
  modes.dof = pairs.dof;
  modes.iterations = pairs.iterations;
  modes.residual = pairs.residual;
  modes.converged = pairs.converged && modes.rounding < kLargestRounding;
  return modes;
}

}  // namespace liana
