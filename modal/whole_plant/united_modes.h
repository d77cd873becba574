// The lowest modes of a whole plant: the T10 meshes of its domains, each of its own material, tied together.
//
// Every node of a child's root interface moves with the place of the parent's mesh that it lies in (or next
// to): u_slave = Σ N_b u_b. The ties are eliminated, K = Tᵀ K T and M = Tᵀ M T with one scalar weight for
// each pair of nodes. This works for domains that overlap, touch or leave a gap, as modelling tools export
// them, and keeps the meshes that the domains' own frequencies were found on; what a child has inside of its
// parent counts in both.
#pragma once

#include <vector>

#include "mesher/base/progress.h"
#include "mesher/tets/tet_mesh.h"
#include "modal/elements/assembly.h"

namespace liana {

struct UnitedPart {
  TetMesh mesh;
  ElasticMaterial material;
  std::vector<ElementScaling> scaling;  ///< per tet; empty if uniform
  int parent = -1;                      ///< index of a part before it; -1: held at its root faces
};

struct UnitedModes {
  std::vector<double> frequencies;  ///< Hz, ascending
  std::vector<NodeMesh> meshes;     ///< per part
  /// Per part: 3 nodes × modes, displacement, of unit modal mass (kg).
  std::vector<NodalVectors> shapes;
  uint32_t dof = 0;
  size_t tied_nodes = 0;
  bool converged = false;
};

/// Throws Error{Input} when a part has no root face or no part is held.
UnitedModes united_modes(const std::vector<UnitedPart>& parts, int count);

}  // namespace liana
