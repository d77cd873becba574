// Stiffness and mass of a beam through elliptic sections.
//
//   A, I_w, I_t   area (m²) and second moments (m⁴) of a section: π a³ b / 4 and π a b³ / 4 of half axes a >
//   b J             torsion constant of the ellipse, π a³ b³ / (a² + b²), m⁴ κ             shear factor 6 (1
//   + ν) / (7 + 6 ν) ([Cowper 1966], circle) Φ             12 E I / (κ G A h²) of an element of length h: its
//   share of shear
#pragma once

#include <Eigen/Dense>
#include <span>

#include "modal/domains/beam_sections.h"
#include "modal/elements/carried_mass.h"
#include "modal/material/elastic_material.h"

namespace liana {

/// K and M in units of E ℓ and ρ ℓ³, 6 dof a node (displacement over ℓ, rotation), the first node not held.
struct BeamMatrices {
  Eigen::MatrixXd stiffness, mass;
  double unit = 0;  ///< ℓ, m: the length of the line
};

/// Two-node elements of [Timoshenko 1921] bending (exact for loads at their ends, [Przemieniecki 1968,
/// §5.6]), stretch and torsion. A carried mass sits on a rigid arm from the nearest point of the line.
BeamMatrices beam_matrices(const std::vector<Section>& sections, const ElasticMaterial& material,
                           std::span<const CarriedMass> carried);

/// a × as a matrix.
Mat3 cross_matrix(const Vec3& a);

}  // namespace liana
