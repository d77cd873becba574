// How near two particles of plants are: stems as capsules, blades as ellipsoids.
#pragma once

#include <algorithm>

#include "runtime/sim/model/plant.h"

namespace liana {

/// One particle as others meet it.
struct Proxy {
  const Particle& particle;
  const Motion& motion;
  bool blade;
};

/// The same in single precision, for a first look at many.
struct Outline {
  Outline(const Proxy& proxy);
  Eigen::Vector3f half_box() const;  ///< along the axes of the world, m
  /// True if a quick look shows more than `gap` (m) between them; never if it is less.
  bool apart(const Outline& other, float gap) const;

  Eigen::Vector3f centre;  ///< m
  Eigen::Matrix3f axes;    ///< columns: halves of width, length and thickness, m
  bool blade;

 private:
  float radius() const { return std::max(axes.col(0).norm(), axes.col(2).norm()); }
  float reach(const Eigen::Vector3f& n) const;
};

struct ContactGeometry {
  Vec3 normal;        ///< unit, from b to a
  double gap;         ///< m; < 0 while they overlap
  double soft;        ///< m: deeper than that they resist harder than lightly
  Vec3 arm_a, arm_b;  ///< from the centres to where they meet, m
};

/// Two stems: along the line between the closest points of their axes, each as thick as its elliptical
/// cross-section is that way. A stem and a blade, or two blades: as ellipsoids (see touch()).
/// side: the normal when they met last, or null. Whoever has passed the other since counts as overlapping, to
/// come out on the side that it came from; but what is deeper in a blade than a quarter of its width is let
/// go. far: m; beyond it a gap need not be exact.
ContactGeometry narrow_phase(const Proxy& a, const Proxy& b, const Vec3* side, double far);

}  // namespace liana
