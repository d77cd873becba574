// The global K and M of one solid: 3×3 stiffness blocks and one mass scalar for each pair of coupled nodes.
#pragma once

#include <span>
#include <vector>

#include "modal/elements/node_mesh.h"
#include "modal/material/elastic_material.h"

namespace liana {

/// Rows are dof, 3 a node; columns are vectors. Row-major: a node's entries lie together.
using NodalVectors = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Both matrices are symmetric; the lower triangle is stored by columns of nodes, the diagonal first.
/// Dimensionless: lengths in units of `length`, K in E · length, M in ρ · length³. A matrix in Pa·m and one
/// in kg of a millimetre twig lie 15 decades apart; in these units every shape of the same proportions gives
/// the same numbers.
struct System {
  std::vector<uint32_t> start;  ///< nodes + 1: where each column begins
  std::vector<uint32_t> row;    ///< per entry: node, >= column
  std::vector<Mat3> stiffness;  ///< per entry
  std::vector<double> mass;     ///< per entry
  double length = 1;            ///< m, the unit of length
  double time = 1;              ///< s, length · √(ρ/E): ω = √λ / time
  double mass_unit = 1;         ///< kg, ρ · length³

  size_t nodes() const { return start.size() - 1; }
  void add_mass(uint32_t node, double kilograms) { mass[start[node]] += kilograms / mass_unit; }
  NodalVectors multiply_mass(const NodalVectors& x) const;
  NodalVectors multiply_stiffness(const NodalVectors& x) const;
};

/// Factors of one element on the material's Young's modulus and density.
struct ElementScaling {
  double stiffness = 1, density = 1;
};

/// Consistent mass, exact integration. scaling: one for each element; empty if the material is uniform. The
/// system's units stay those of `material`.
System assemble(const NodeMesh& mesh, Element element, const ElasticMaterial& material,
                std::span<const ElementScaling> scaling = {});

}  // namespace liana
