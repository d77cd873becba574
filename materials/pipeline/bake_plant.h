// The offline stage: a segmented plant and a species become a bake.
#pragma once

#include <string>
#include <vector>

#include "materials/bake/bake.h"
#include "mesher/base/progress.h"
#include "mesher/plant/segmented_plant.h"
#include "mesher/tets/tetrahedralize.h"
#include "modal/solve/lowest_mode.h"

namespace liana {

class BakeCache;

struct BakeOptions {
  Element element = Element::T10;
  TetOptions tets;
  unsigned threads = 0;  ///< 0: one per core
  bool strict = false;   ///< throw at the first domain that cannot be made solid instead of leaving it out
  BakeCache* cache = nullptr;  ///< solids and modes are looked up in it and added; the caller saves it
};

/// Wall clock, s. Tets and modes are made in one go; their time is split as the workers spent it.
struct StageSeconds {
  double read = 0, write = 0;  ///< of the plant and of the bake; the caller's to fill
  double cache = 0;            ///< its file, in and out; the caller's to fill
  double surface = 0, tets = 0, modal = 0, laws = 0, total = 0;
};

struct BakeResult {
  Bake bake;  ///< species_hash is the caller's to fill: it names the file the law was read from
  std::vector<DomainId>
      baked_as;  ///< per domain of the plant: its id in the bake, invalid if it was left out
  StageSeconds seconds;
  std::vector<std::string> notes;  ///< what a user should know though nothing failed
};

/// Per domain: closed surface -> mass of all that hangs on it -> tetrahedra -> lowest mode -> [Wang17] Eq.
/// 8-10, 13, 15.
///
/// The mass a domain carries is that of all its descendants as the law scales it, Σ α_m ρ V, lumped where
/// each child is attached. The default solve carries it divided by the domain's own α_m: scaling that M by
/// α_m as in [Wang17] Eq. 3 then gives the domain's scaled mass and the true carried one, and Eq. 10 is
/// exact: solved again with E = α_k E_default, ρ = α_m ρ_default and the true carried masses, the domain
/// swings at ν.
///
/// A domain that cannot be made solid, or whose modes do not come out, is left out and named in Bake::failed;
/// its children attach to its nearest ancestor that stayed. Throws Error{Input} when none is left, when the
/// species has no law for a group (before any work), or, with strict, at the first failure; Error{Cancelled}
/// when progress says so.
BakeResult bake_plant(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
                      Progress& progress);

}  // namespace liana
