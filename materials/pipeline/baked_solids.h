// The tets of a baked plant with the materials of its bake: what whole-plant analysis and pictures are made
// of.
#pragma once

#include "materials/bake/bake.h"
#include "mesher/io/vtu_writer.h"
#include "mesher/plant/segmented_plant.h"
#include "modal/whole_plant/united_modes.h"

namespace liana {

/// One part for each domain of the bake, in its order, made on all cores. Throws Error{Input} when the plant
/// is not the bake's, and naming the domain when it could only be made a beam, which has no tets.
std::vector<UnitedPart> baked_solids(const SegmentedPlant& plant, const Bake& bake);

/// Each domain by itself, held at its root: its lowest mode, as the bake found it with its own material but
/// without what it carries. nu, E, density and domain (index) for each cell; mode for each point.
VtuMesh domains_vtu(const Bake& bake, const std::vector<UnitedPart>& parts);

/// The whole plant: modes as mode1, mode2, ... for each point, scaled to a largest displacement of 1; the
/// materials for each cell, the frequencies (Hz) for the file.
VtuMesh united_vtu(const Bake& bake, const std::vector<UnitedPart>& parts, const UnitedModes& modes);

}  // namespace liana
