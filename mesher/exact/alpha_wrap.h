// A closed surface around any triangles (Portaneri et al. 2022), by CGAL.
#pragma once

#include <optional>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Points after which alpha_wrap() gives up: a second or so.
constexpr size_t kMostWrapPoints = 4000;

/// A closed, oriented surface without self-intersection that holds all the triangles inside, at about
/// `offset` (m) from them; it does not enter openings narrower than `alpha` (m), which is also about its
/// edges' length. The triangles may be anything: open, crossing, wound either way. Nothing if CGAL gives
/// up or more than kMostWrapPoints points would be needed.
std::optional<Mesh> alpha_wrap(const Mesh& triangles, double alpha, double offset);

}  // namespace liana
