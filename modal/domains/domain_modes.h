// The lowest modes of all domains of a plant: in parallel, and once for each shape.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/progress.h"
#include "mesher/tets/tetrahedralize.h"
#include "modal/domains/same_shape.h"
#include "modal/solve/lowest_mode.h"

namespace liana {

struct DomainModes {
  std::vector<double> frequencies;  ///< Hz, ascending
  std::vector<Vec3> tip_direction;  ///< per mode, unit
  Sway sway;                        ///< bending the soft and the stiff way
  uint32_t tets = 0, dof = 0;
  int iterations = 0;
  double residual = 0;
  bool converged = false;
  size_t solved_as =
      0;  ///< the solid whose solution this is, by index: itself, or an earlier copy of its shape
  std::string failure;   ///< why there are no modes; empty if there are
  bool as_beam = false;  ///< solved as a beam through its sections (beam_mode.h), within 3 % where `note`
                         ///< does not say rough
  std::string note;      ///< what a user should know of the way, each with a leading "+"
};

/// Of a copy of the original under the similarity, of the same material.
DomainModes moved(const DomainModes& original, const Similarity& similarity);

struct DomainModesOptions {
  ModeOptions modes;
  TetOptions tets;
  bool share_equal_shapes = true;
  unsigned threads = 0;  ///< 0: one a core
};

struct AllModes {
  std::vector<DomainModes> domains;  ///< one for each solid, in order
  double tet_seconds = 0;            ///< summed over the workers
  double mode_seconds = 0;
};

/// Tetrahedralizes and solves every solid; the tets live only as long as their solution takes. Solids that
/// are copies up to rotation and scale s are solved once: with the same material and carried masses scaled by
/// s³, ν scales with 1/s. An Error of one solid becomes its `failure`; the others go on. The results do not
/// depend on the number of threads. Progress: one step for each solid that is solved. Throws
/// Error{Cancelled}.
AllModes solve_domains(const std::vector<Solid>& solids, const ElasticMaterial& material,
                       const DomainModesOptions& options, Progress& progress);

}  // namespace liana
