// K x = ω² M x for the lowest modes of one solid domain, held at its root, carrying point masses.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/tets/tet_mesh.h"
#include "modal/elements/assembly.h"
#include "modal/elements/carried_mass.h"
#include "modal/material/elastic_material.h"

namespace liana {

struct ModeOptions {
  Element element = Element::T10;
  int modes = 2;  ///< how many of the lowest to return
};

/// How a solid sways about its root: the Rayleigh quotients of its static deflections under uniform
/// acceleration, the softest direction first (within 1 % above the frequencies of the modes that look so). A
/// leaf's second mode is torsion; this names its lowest bending in both directions.
struct Sway {
  std::array<double, 2> frequencies{};  ///< Hz: bending the soft way, and the stiff way
  std::array<Vec3, 2> directions{};     ///< unit: mean displacement of either
};

struct Modes {
  std::vector<double> frequencies;      ///< Hz, ascending
  std::vector<Eigen::VectorXd> shapes;  ///< per mode, 3 × nodes: displacement of every node, M-normalised
  std::vector<Vec3> tip_direction;      ///< per mode, unit: displacement of the node that moves most
  Sway sway;
  uint32_t dof = 0;
  int iterations = 0;
  double residual = 0;  ///< of EigenResult
  /// Max over modes of how far the assembled K's eigenvalue lies from the shape's strain energy, relative:
  /// what rounding has done to the shape of a very thin solid. The frequency's own error is about its square.
  double rounding = 0;
  bool converged = false;  ///< residual below 3e-5, rounding below 0.1
};

/// Nodes are the tet mesh's vertices, then (T10) the mid-edge nodes of make_nodes(). All nodes of root_faces
/// are held. Throws Error{Input} when no face is held, a part hangs on nothing, or the matrix is singular.
/// scaling: factors on the material for each tet; empty if it is uniform.
Modes lowest_modes(const TetMesh& mesh, const ElasticMaterial& material, std::span<const CarriedMass> carried,
                   const ModeOptions& options = {}, std::span<const ElementScaling> scaling = {});

}  // namespace liana
