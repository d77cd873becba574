// Closed surface -> tetrahedra, by TetGen (which only tetgen_driver.cpp sees).
#pragma once

#include <span>

#include "mesher/base/mesh.h"
#include "mesher/tets/tet_mesh.h"

namespace liana {

struct TetOptions {
  double radius_edge_ratio = 100;  ///< TetGen's q: quality bound
  double min_dihedral = 10;        ///< degrees
};

/// The surface must be closed, oriented outward and free of self-intersection; that is checked before TetGen
/// sees it, because TetGen aborts the process otherwise. The result's volume equals the surface's to 1e-6.
/// is_root: per triangle, as SolidDomain::is_root. Throws Error{Input} with the reason.
TetMesh tetrahedralize(const Mesh& surface, std::span<const uint8_t> is_root, const TetOptions& options = {});

}  // namespace liana
