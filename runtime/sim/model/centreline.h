// A domain's centreline by arc length: where it runs and how thick it is there.
#pragma once

#include <vector>

#include "materials/bake/bake.h"

namespace liana {

class Centreline {
 public:
  /// Throws Error{Input} naming the domain when the centreline has no length or no thickness.
  /// taper: of E and density along it ([Wang17] Eq. 11).
  explicit Centreline(const BakedDomain& domain, const TaperLaw& taper = {});

  double length() const { return arc_.back(); }  ///< m
  /// s in m, 0 at the root. A section thinner than a twentieth of the widest counts as that twentieth: tips
  /// are drawn to a point, but a joint there needs some stiffness.
  Station at(double s) const;
  /// Half width × half thickness, integrated from s0 to s1 (m³): proportional to volume.
  double volume_share(double s0, double s1) const;
  /// The same times Eq. 11: proportional to mass.
  double mass_share(double s0, double s1) const;
  double material_scaling(double s) const;  ///< Eq. 11
  double mean_diameter() const;             ///< m, of the circle of equal area

 private:
  std::vector<Station> stations_;
  TaperLaw taper_;
  std::vector<double> arc_;
  double least_width_ = 0, least_thickness_ = 0;
};

}  // namespace liana
