// Surfaces in closed form that tests and benchmarks share. Metres; along +y from the origin, root at y = 0.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

/// A closed surface with its root interface.
struct MarkedMesh {
  Mesh mesh;                     ///< oriented outward
  std::vector<uint8_t> is_root;  ///< per triangle: 1 on the interface with the parent
};

struct TubeShape {
  int sides = 6;
  double length = 1;
  double diameter = 0.05;  ///< circumscribed
  double tip_scale = 1;    ///< tip diameter over root diameter
  double bend = 0;  ///< rad: the centreline is an arc of this angle, of length `length`, in the xy plane
  std::vector<double> stations;  ///< along the centreline, m, from 0 to length; empty: graded_stations()
  bool root_cap = true, tip_cap = true;
};

/// Rings of a clamped branch: 0, 0.5 d, 1.5 d, 3.5 d, ... while steps are below length/6, then even.
std::vector<double> graded_stations(double length, double diameter);

/// n-gon prism (or cone frustum, or arc), each cap a fan around its centre vertex. is_root marks the root
/// cap.
MarkedMesh make_tube(const TubeShape& shape);

/// make_tube with both caps, straight: the cantilever of the closed forms.
MarkedMesh make_prism(int sides, double length, double diameter);

double polygon_area(int sides, double diameter);  ///< m², of the n-gon with this circumscribed diameter
double polygon_second_moment(int sides, double diameter);  ///< m⁴, about any axis in its plane

/// One-sided sheet with a leaf's outline or (pointed = false) a rectangle: along +y, wide in x, its normal
/// near +z. It is bent about x into an arc of the angle `bend` and folded by `fold` rad along the midrib
/// (flat if both are 0).
struct LeafCard {
  double length = 0.06, width = 0.04;
  int along = 6, across = 4;  ///< quads
  double bend = 0.3, fold = 0.2;
  bool pointed = true;
};
Mesh make_leaf_card(const LeafCard& shape);

/// The six sides of a box as 12 triangles, from corner to corner + size.
Mesh make_box(const Vec3& corner, const Vec3& size);

Mesh transformed(const Mesh& mesh, const Affine3& transform);  ///< mirrored transforms flip the winding

/// A trunk, three branches, one twig on each and two leaf cards a twig: 13 domains on three levels and
/// leaves. Open tubes whose base ring lies on the parent's centreline, as modelling tools export them.
SegmentedPlant make_small_plant();

}  // namespace liana
