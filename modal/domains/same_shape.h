// Which solids are copies of one another up to rotation, translation and scale.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mesher/geometry/mesh.h"
#include "mesher/geometry/similarity.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "modal/elements/carried_mass.h"
#include "modal/material/taper_law.h"

namespace liana {

/// A solid to analyse. The referenced mesh must outlive it.
struct Solid {
  const Mesh* surface = nullptr;     ///< closed, oriented outward, free of self-intersection
  std::span<const uint8_t> is_root;  ///< per triangle: 1 on the interface that is held
  std::vector<CarriedMass> carried;  ///< what hangs on it
  TaperLaw taper = {};               ///< of E and density along it, [Wang17] Eq. 11
  std::span<const Section> line;     ///< its sections; where there are some, a beam stands in for failed tets
  double volume = 0;                 ///< m³, of the sections' solid; 0: unknown
  bool is_beam = false;              ///< solve the beam only: the surface is no solid
};

/// Numbers that equal shapes share: enough to sort by, never enough to call two shapes equal.
struct ShapeSignature {
  uint64_t connectivity = 0;  ///< hash of triangles, root flags and the number of carried masses
  double compactness = 0;     ///< area³ / volume²: without unit, the same at any scale
  double extent = 0;          ///< m, root mean square distance of the vertices from their mean
  double thickness = 0;       ///< m, 2 volume / area
};
ShapeSignature shape_signature(const Solid& solid);

/// The similarity that takes `from` onto `to`, if there is one: the same triangles and root, every vertex
/// within 0.2 % of the thickness, every carried mass within 0.1 % of the extent and of scale³ times its mass.
/// Such copies have frequencies within about 0.2 % of ν / scale. Mirror images do not match.
std::optional<Similarity> find_similarity(const Solid& from, const Solid& to);

}  // namespace liana
