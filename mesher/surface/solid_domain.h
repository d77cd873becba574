// A domain's surface made solid: closed, outward, graded towards its root, with the root interface marked.
#pragma once

#include <string>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

/// A cross-section along the centreline of a domain.
struct Section {
  Vec3 centre;            ///< m
  double half_width;      ///< m, half axis of the ellipse with the section's second moments, wide axis
  double half_thickness;  ///< m, the same, thin axis
  Vec3 thin_axis;         ///< unit, perpendicular to the centreline
};

struct SolidDomain {
  Mesh surface;                     ///< closed, oriented outward, no self-intersection
  std::vector<uint8_t> is_root;     ///< per triangle: 1 on the interface with the parent (ground for a trunk)
  Vec3 root;                        ///< centre of the root interface, m
  double length = 0;                ///< ℓ: longest geodesic from the root interface, m ([Wang17] §4.2)
  double volume = 0;                ///< enclosed, m³
  std::vector<Section> centreline;  ///< root to tip, at least 2
  std::string route;                ///< how it was made solid, e.g. "weld+cap", "sheet-extruded"
};

/// Throws Error{Input} naming the domain and the reason when it cannot be made solid.
SolidDomain make_solid(const SegmentedPlant& plant, DomainId domain);

}  // namespace liana
