// The eigenvalue of a shape from the strains of its elements: what a thin blade's K can no longer tell.
#pragma once

#include "modal/elements/assembly.h"
#include "modal/material/elastic_material.h"

namespace liana {

/// Per column x of `shapes` (3 nodes rows): xᵀ K x in the system's units, summed over the elements as
/// ∫ λ (tr ε)² + 2 μ ε:ε dV.
///
/// A blade of thickness t and length ℓ bends so softly that xᵀ K x is (t/ℓ)⁴ of the terms it is summed from:
/// with the assembled K its relative rounding error is about ε (ℓ/t)⁴, 0.6 % at ℓ/t = 2,000. Strains are
/// formed from differences of displacements inside one element, and lose only ε (ℓ/t)².
Eigen::VectorXd stiffness_quotients(const NodeMesh& mesh, const System& system, double poisson_ratio,
                                    const NodalVectors& shapes, std::span<const ElementScaling> scaling = {});

}  // namespace liana
