// A closed surface around any triangles (Portaneri et al. 2022), by CGAL.
#pragma once

#include <optional>

#include "mesher/base/mesh.h"

namespace liana {

/// A closed, oriented surface without self-intersection that holds all the triangles inside, at about
/// `offset` (m) from them; it does not enter openings narrower than `alpha` (m), which is also about its
/// edges' length. The triangles may be anything: open, crossing, wound either way. Nothing if CGAL gives up.
std::optional<Mesh> alpha_wrap(const Mesh& triangles, double alpha, double offset);

}  // namespace liana
