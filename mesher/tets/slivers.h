// Tets without thickness: four points of a flat quad or a circle.
#pragma once

#include "mesher/tets/tetgen_driver.h"

namespace liana {

/// The least height of a tet: 3 V over its largest face, m.
double least_height(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Removes the tets lower than `height` (m). They hold next to no volume, but their stiffness grows with 1 /
/// height and drowns the solid's own in rounding (a rod of aspect 100 is 14 % off with heights of 1e-8 d).
///
/// Between two boundary triangles that share a diagonal, the boundary takes the other diagonal and the mesh
/// stays conforming. Inside, the faces above and below keep their four corners and the edges around in common
/// and only the nodes of the two diagonals, which lie at one point, go separate ways: exact for linear
/// displacements. TetGen, which may not touch the boundary, would insert points instead and take ten times as
/// long.
///
/// Returns false, with the mesh in between, if more than `volume` (m³) would go or a root face would be lost.
bool remove_slivers(TetGenResult& mesh, double height, double volume);

}  // namespace liana
