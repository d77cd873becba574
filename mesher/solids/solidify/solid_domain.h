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
  double area = 0;        ///< m², of the section itself; 0: that of the ellipse
};

struct SolidDomain {
  Mesh surface;                     ///< closed, oriented outward, no self-intersection
  std::vector<uint8_t> is_root;     ///< per triangle: 1 on the interface with the parent (ground for a trunk)
  Vec3 root;                        ///< centre of the root interface, m
  double length = 0;                ///< ℓ: longest geodesic from the root interface, m ([Wang17] §4.2)
  double volume = 0;                ///< enclosed, m³
  std::vector<Section> centreline;  ///< root to tip, at least 2
  std::string route;                ///< how it was made solid, e.g. "capped", "sheet-extruded+2-rings"
  /// No solid could be made: the centreline's sections are all there is, and the surface is a tube through
  /// them that may pass through itself. Its modes are a beam's (modal/domains/beam_mode.h).
  bool is_beam = false;
  /// What mending cost: shares of the modelled area, and of the volume (either way where it was untangled).
  /// Not of wraps and beams, whose routes say what they are.
  double lost_area = 0, lost_volume = 0;
};

/// The repair ladder, cheapest rung first; each leaves its name in `route`:
///   "closed", "capped", "sheet-extruded"  cleaned, wound alike, closed by lids or given its thickness
///   "+N-slits-closed", "+N-inner-or-loose-faces-dropped", "+N-pinches-parted"  damage put right (mend.h)
///   "+untangled"        self-intersections cut out and filled anew (untangle.h)
///   "+alpha-wrapped"    a new surface around everything (alpha_wrap.h), pulled back onto the old one where
///                       they are near: frequencies within 3 %
///   "beam"              a beam through the sections (beam_shape.h): frequencies within 3 %
///   "rough-beam"        the same of a leaf: may be far off where it is wide or folded
/// Throws Error{Input} naming the domain and the reason when it has no recoverable shape.
SolidDomain make_solid(const SegmentedPlant& plant, DomainId domain);

}  // namespace liana
