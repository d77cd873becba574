// Stiffness and consistent mass of straight-sided tetrahedra, integrated exactly in closed form.
//
//   L_k      barycentric coordinate of corner k;  g_k = ∇L_k, constant in the element, 1/m
//   N_a      shape function of node a: corners L_a (2 L_a − 1), edges 4 L_c L_d  (T10);  L_a  (T4)
//   λ, μ     Lamé's constants, Pa
//   K_ab     3×3 block: ∫ λ ∇N_a ∇N_bᵀ + μ ∇N_b ∇N_aᵀ + μ (∇N_a·∇N_b) I dV, N/m
//   M_ab     scalar (times I): ρ ∫ N_a N_b dV, kg
// With ∫ L_k L_l dV = V (1 + δ_kl) / 20 every entry is a sum of at most four outer products g_k g_lᵀ.
#pragma once

#include <array>
#include <span>

#include "modal/elements/node_mesh.h"
#include "modal/material/elastic_material.h"

namespace liana {

struct LameConstants {
  double lambda, mu;  ///< Pa

  static constexpr LameConstants of(double youngs_modulus, double poisson_ratio) {
    return {youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
            youngs_modulus / (2 * (1 + poisson_ratio))};
  }
  constexpr LameConstants scaled(double factor) const { return {factor * lambda, factor * mu}; }
};

/// Place of the node pair a >= b in a packed lower triangle.
constexpr int pair_index(int a, int b) {
  return a * (a + 1) / 2 + b;
}
constexpr int pair_count(int nodes) {
  return nodes * (nodes + 1) / 2;
}

struct TetGeometry {
  double volume;                  ///< m³
  std::array<Vec3, 4> gradients;  ///< g_k, 1/m
};
TetGeometry tet_geometry(const std::array<Vec3, 4>& corners);

/// Of an element in units of `length` (m), its first corner as origin.
TetGeometry element_geometry(const NodeMesh& mesh, size_t element, double length);

/// K_ab for a >= b, packed by pair_index; 55 blocks for T10, 10 for T4.
void element_stiffness(Element element, const TetGeometry& tet, const LameConstants& lame,
                       std::span<Mat3> blocks);

/// M_ab / (ρ V) for a >= b, packed by pair_index; the same for every element.
std::span<const double> unit_mass(Element element);

}  // namespace liana
