// Power laws through what was measured.
#pragma once

#include <string>
#include <vector>

#include "materials/law/species_law.h"
#include "materials/video/modes/tree_modes.h"

namespace liana {

struct FittedBranch {
  std::string point, domain;
  double length;  ///< ℓ, m
  MeasuredMode measured;
  double fitted;  ///< Hz, C₁ ℓ^ε₁
};

/// [Wang17] Eq. 8 for one group of branches.
struct FittedGroup {
  std::string group;
  double epsilon1;  ///< as the base species gives it
  double c1;        ///< Hz·m^−ε₁
  double c1_sigma;  ///< from the frequencies' uncertainties
  double residual;  ///< Hz, 2-norm of measured − fitted over the branches
  DampingLaw damping;
  std::vector<FittedBranch> branches;
};

/// C₁ of each group minimises the 2-norm of measured − C₁ ℓ^ε₁ over its branches ([Wang17] §7), ε₁ is the
/// base species'. ξ(ν) (Eq. 13) is the mean for one frequency, else the weighted line between the lowest and
/// the highest frequency measured. A trunk that was not tracked but seen in its branches needs trunk_length
/// (m, > 0; else it is left out with a note).
std::vector<FittedGroup> fit_law(TreeModes& tree, const SpeciesLaw& base, double trunk_length);

}  // namespace liana
