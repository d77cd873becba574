// How near two ellipsoids are, and where they would touch.
#pragma once

#include "mesher/base/types.h"

namespace liana {

struct Ellipsoid {
  Vec3 centre;
  Mat3 axes;  ///< columns: the semi-axes, m
  /// How far it reaches from its centre along a unit direction, m.
  double reach(const Vec3& n) const { return (axes.transpose() * n).norm(); }
};

struct EllipsoidTouch {
  Vec3 normal;  ///< unit, from b to a
  double gap;   ///< m, between their planes across `normal`; < 0 exactly if they overlap
  Vec3 at;      ///< m: where the two meet if both are scaled about their centres until they touch
};

/// [Perram, Wertheim 1985, J. Comput. Phys. 58, §3]: the direction in which both, scaled about their centres
/// by the same factor, touch. It varies smoothly, also while they overlap. Apart, `gap` is never more than
/// the distance, and exact when they touch. Stops as soon as some direction shows a gap of more than `far`
/// (m): then the answer is that direction's. Where the centres coincide, `normal` is along a's third axis.
EllipsoidTouch touch(const Ellipsoid& a, const Ellipsoid& b, double far);

}  // namespace liana
