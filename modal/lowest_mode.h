// K x = ω² M x for the lowest modes of one solid domain, held at its root, carrying point masses.
#pragma once

#include <span>
#include <vector>

#include "mesher/base/elastic_material.h"
#include "mesher/tets/tet_mesh.h"

namespace liana {

/// The mass of everything that hangs on the domain at one place, lumped on the vertices nearest to it.
struct CarriedMass {
  Vec3 position;  ///< m
  double mass;    ///< kg
};

enum class Element { T10, T4 };

struct ModeOptions {
  Element element = Element::T10;
  int modes = 2;  ///< how many of the lowest to return
};

struct Modes {
  std::vector<double> frequencies;  ///< Hz, ascending
  std::vector<Eigen::VectorXd> shapes;  ///< per mode, 3 × nodes: displacement of every node, M-normalised
  std::vector<Vec3> tip_direction;  ///< per mode, unit: displacement of the node that moves most
  uint32_t dof = 0;
  int iterations = 0;
  double residual = 0;  ///< max over modes of |K x − λ M x| / |K x|
  bool converged = false;
};

/// Throws Error{Input} when no face is held or the matrix is singular.
Modes lowest_modes(const TetMesh& mesh, const ElasticMaterial& material, std::span<const CarriedMass> carried,
                   const ModeOptions& options = {});

}  // namespace liana
