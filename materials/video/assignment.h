// Which branch a tracked point sits on.
#pragma once

#include <string>
#include <vector>

#include "materials/bake/bake.h"
#include "materials/video/infer.h"
#include "materials/video/tracks/point_tracks.h"

namespace liana {

inline const std::string kStillTarget = "still";

/// All assignments but the still ones. Throws Error{Usage} for an unknown point, domain, group or an absurd
/// length, and for a point that is assigned twice.
std::vector<PointTarget> resolve_targets(const PointTracks& tracks,
                                         const std::vector<PointAssignment>& assignments, const Bake* plant,
                                         const SpeciesLaw& base);

}  // namespace liana
